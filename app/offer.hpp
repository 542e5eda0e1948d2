/// What a finished run offers the library: OUT/entries/SHELF.toml in the library's format. `hosel adopt OUT --as
/// NAME` makes entries of the user's of them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "app/library.hpp"
#include "app/output.hpp"

namespace hosel::app {

/// What is told of an entry beside its values.
struct Offer {
  std::string what;    ///< one sentence for `hosel list`
  std::string source;  ///< the data
  std::vector<std::string> parameters = {};
  std::vector<double> values = {};   ///< in the units of the names
  Eigen::MatrixXd covariance = {};   ///< of the values, or of their logarithms, as `of` says
  std::vector<std::string> of = {};  ///< "value" or "logarithm", one for each parameter
  std::vector<std::string> unidentified = {};
  Seen seen = {};
};

/// A text as TOML, as the resolved case has it: what a file may not hold as it is (DEL, what is no character) escaped.
std::string toml_text(const std::string& text);

/// Tables of an entry, as the reader takes them. Throws std::invalid_argument for a layer whose law is no polynomial.
std::string ball_tables(const Ball& body, const models::FeBall& layers);
std::string face_tables(const FaceCompliance& face);
/// `face` is a name of the library, or `kRigidFace`; `loft` of the face at its centre, where it is known [rad].
std::string head_tables(const Head& head, std::string_view face, const std::optional<double>& loft,
                        const std::optional<ClubGeometry>& geometry);
/// The parts that are there.
std::string contact_tables(const NamedContact& contact);

/// Writes OUT/entries/SHELF.toml and reads it again by the library's reader: what it would refuse is not offered, and
/// the run says so.
void offer(Output& out, Shelf shelf, const Offer& offer, const std::string& tables);
/// Nothing is offered: entries of an earlier run in OUT go.
void withdraw_offers(Output& out);

/// `hosel adopt`: the entries of a finished run become entries NAME of the user's library. Returns their files. Throws
/// InputError where the run is not finished or offers nothing, where the name is no name, is a shipped entry's, or is
/// there already (without `force`).
std::vector<std::filesystem::path> adopt(const std::filesystem::path& out, const std::string& name, bool force);

}  // namespace hosel::app
