/// Measured shots as a Problem of the engine: rows to trials, split, noise, screening, tests for structure, design.
#pragma once

#include <memory>
#include <optional>
#include <set>

#include "loop/shots/audit.hpp"
#include "loop/shots/case.hpp"
#include "loop/shots/inputs.hpp"
#include "loop/shots/screen.hpp"
#include "loop/shots/split.hpp"
#include "loop/shots/structure.hpp"

namespace hosel::loop {

class ShotProblem : public Problem {
 public:
  /// `derived`: outputs among them are no channels. `held_rows`: the holdout, where it is not split here; none
  /// of them is screened. `doubted`: an input whose record counts for nothing. Throws DataError where the columns are
  /// of no use at all.
  ShotProblem(const ShotCase& c, const std::vector<DerivedColumn>& derived, std::optional<std::set<int>> held_rows,
              std::optional<Input> doubted);

  /// Every form that can act on these shots.
  std::vector<Parametrisation> forms() const;
  const std::map<std::string, int>& unused() const { return inputs_.unused; }  ///< reason, rows
  const ShotModel& model() const { return *model_; }
  const std::vector<int>& training() const { return rows_.train; }

  int width() const final { return model_->width(); }
  const Channel& channel(int c) const override { return model_->channel(c); }
  void refute(int c, bool refuted) override { model_->channel(c).refute(refuted); }
  std::vector<Row> rows() const override;
  const Eigen::MatrixXd& measured() const override { return model_->measured(); }
  std::vector<Flag> flags() const override;
  std::vector<std::string> notes() const override;
  std::optional<std::string> too_few() const override;

  bool whitened(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z, double) const override {
    z = model_->whitened(shots(part), model, p);
    return true;
  }
  bool linearise(Part part, const Model& model, const Eigen::VectorXd& p, Eigen::VectorXd& z, Eigen::MatrixXd& jacobian,
                 double) const override {
    model_->linearise(shots(part), model, p, z, jacobian);
    return true;
  }
  Eigen::MatrixXd jacobian(Part part, const Model& model, const Eigen::VectorXd& p) const override {
    return model_->jacobian(shots(part), model, p);
  }
  Eigen::MatrixXd residuals(const Model& model, const Eigen::VectorXd& p) const override {
    return model_->residuals(model, p.data());
  }
  Density density(Part part) const override;
  std::vector<std::vector<bool>> subsets() const override;
  std::vector<Stage> stages() const override { return stages_of_shots(width()); }

  bool screen(const Selection& selection) override;
  Scatter scatter(int channel, const Eigen::MatrixXd& residuals, int fitted) const override;
  double sigma(int row, int channel) const override { return model_->sigma(row, channel); }
  double update_noise(const Fit& selected, const Fit& richest) override;

  StructureMap structure(const Fit& fit, const Fit& near, const Eigen::MatrixXd& directions,
                         const Rules& rules) const override;
  std::optional<Remainder> remainder(const Fit& fit) const override;
  std::vector<Mechanism> mechanisms(const Selection& selection, const Rules& rules) const override;
  std::vector<Attenuation> attenuations(const Fit& fit) const override;
  std::optional<Clustered> clustered(const Fit& base, const Fit& fit) const override;
  std::vector<GroupSpread> between_groups(const Fit& fit) const override;
  std::vector<Location> places(const Selection& selection) const override;
  std::vector<Location> shapes(const Selection& selection) const override;
  std::optional<std::string> heavy_tails(const Selection& selection) const override;
  std::vector<Location> doubts(const Selection& selection) const override;
  NextExperiment next_experiment(const LoopResult& so_far) const override;

 private:
  void read(const std::vector<DerivedColumn>& derived, std::optional<Input> doubted);
  void vary(const std::vector<Parametrisation>& all, const Known& k);
  void distrust(Input input);
  void split(const std::set<int>& without);
  void estimate_noise(const Fit* at);
  void set_covariance(const Model& model, const double* parameters);
  const std::vector<int>& shots(Part part) const {
    return part == Part::select ? select_ : part == Part::train ? rows_.train : rows_.holdout;
  }
  std::optional<Location> two_populations(const Selection& s) const;
  bool in_session() const;
  std::vector<RowFlag> single_flags() const;
  void put_back_together();
  /// Shots beyond what noise does to one in a thousand.
  struct FarOff {
    int rows = 0, lost = 0, all = 0;  ///< flagged one by one or far off; flagged or where the loss is flat; of so many
    bool many = false;                ///< more than exceptions are
    std::string column;               ///< in which more than half of `rows` are flagged; empty: no one
    std::string said() const;
  };
  FarOff far_off(const Selection& s) const;

  const ShotCase& case_;
  const std::optional<std::set<int>> held_rows_;
  Inputs inputs_;
  std::unique_ptr<ShotModel> model_;
  std::vector<ColumnUse> uses_;
  std::vector<int> usable_;  ///< shots whose base answer exists
  Rows rows_;
  std::vector<int> select_;             ///< of the training shots
  std::set<int> out_;                   ///< shots that are flagged
  std::vector<RowFlag> early_, flags_;  ///< before rows could become shots; all
  std::string widespread_;              ///< see Screening
  int many_ = 0;
  std::vector<Regressor> regressors_;
  std::vector<std::string> notes_;
  bool updated_ = false;
};

}  // namespace hosel::loop
