/// One model asked about many blows of a case, which differ in the inputs of golf/quantities.hpp alone.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "app/reader.hpp"
#include "golf/blow.hpp"
#include "golf/quantities.hpp"
#include "models/fe/plate_face.hpp"
#include "models/impact_model.hpp"

namespace hosel::app {

/// A blow is answered as its case would be with these inputs: by the parameters that the case's ball has for it, and
/// not at all where the case would be refused. From any thread.
class AskedModel {
 public:
  /// `name` empty: the first model of the case. Throws InputError on a faulty case, and on one that a swing delivers.
  AskedModel(const std::string& where, const std::string& name, const std::vector<std::string>& overrides);
  ~AskedModel();

  const std::string& name() const { return name_; }

  /// The checked launches of `count` blows, on all cores. `values`: a row for each blow, a column for each of `inputs`
  /// [SI]. Throws InputError with the number of the first blow, from 0, with which the case would be refused; nothing
  /// is computed then.
  std::vector<models::Answer> launches(std::size_t count, std::span<const Input> inputs,
                                       std::span<const double> values) const;

  /// A sentence where some of these blows strike the ball off the face, with the first of them; empty else.
  std::string doubt(std::size_t count, std::span<const Input> inputs, std::span<const double> values) const;

 private:
  struct Set;
  CaseFile with(const Blow& blow) const;
  const Set& set_for(const Blow& blow) const;

  CaseFile file_;
  std::string name_;
  Blow blow_;             // the case's own
  bool several_ = false;  // the case's ball has several sets of parameters
  std::shared_ptr<const models::PlateOnDemand> plate_;
  mutable std::mutex mutex_;
  mutable std::map<std::string, std::unique_ptr<const Set>> sets_;  // by name
};

}  // namespace hosel::app
