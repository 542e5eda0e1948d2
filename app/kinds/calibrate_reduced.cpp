#include "app/kinds/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/library.hpp"
#include "app/offer.hpp"
#include "app/read_blow.hpp"
#include "app/read_options.hpp"
#include "models/calibration/reduced_calibration.hpp"
#include "models/oblique.hpp"
#include "post/csv.hpp"

namespace hosel::app {
namespace {

/// One club and the blows that it strikes: a grid of speeds and lofts at the centre, and off-centre strikes at the mean
/// of both.
struct Set {
  std::string name;
  models::FeImpactOptions fe;
  std::vector<Blow> blows;
  std::vector<double> lofts;         ///< of the grid [rad]
  std::vector<std::string> faces;    ///< for which the set is, beside the head's own
  std::vector<std::string> changes;  ///< of the case
};

class CalibrateReducedJob final : public Job {
 public:
  explicit CalibrateReducedJob(CaseFile& file) {
    Table root = file.root();
    const std::size_t count = root.tables("sets").size();
    if (count == 0) root.fail("sets", "name at least one club: [[sets]]");
    for (std::size_t i = 0; i < count; ++i) {
      const Set plain = read_set(root, i);  // as the case stands: which keys the set changes
      std::vector<std::string> changes = plain.changes;
      changes.insert(changes.end(), file.overrides().begin(), file.overrides().end());  // the command line's last word
      CaseFile own(file, changes);
      sets_.push_back(read_set(own.root(), i));
      if (std::ranges::count(sets_, sets_.back().name, &Set::name) > 1)
        root.fail("sets", fmt::format("'{}' is there twice", sets_.back().name));
      for (std::size_t k = 0; k < count; ++k)
        if (k != i) read_set(own.root(), k);  // every set's keys are known
      own.root().leave({"kind", "title"});
      own.finish();
    }
  }

  void run(Output& out) override {
    nlohmann::json summary;
    std::string toml,
        csv =
            "set,model,ball_speed_rms_mps,ball_speed_max_mps,launch_angle_rms_deg,launch_angle_max_deg,azimuth_rms_deg,"
            "azimuth_max_deg,spin_rms_rpm,spin_max_rpm\n";
    post::TextTable page{{{"set", "model", "ball speed [m/s]", "launch angle [deg]", "azimuth [deg]", "spin [rpm]"}}};
    post::TextTable fitted{.rows = {}, .first_width = 38};
    out.say("set        model            ball speed [m/s]  launch [deg]  azimuth [deg]      spin [rpm]   (rms, max)");
    Progress progress = out.progress("sets");
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Set& set = sets_[i];
      const models::ReducedCalibration fit = models::calibrate_reduced(set.fe, set.blows);
      progress.update(double(i + 1) / double(sets_.size()), set.name);
      for (const models::ReducedBand& b : fit.bands) {
        const double spin_rms = rpm(b.spin_rms), spin_max = rpm(b.spin_max);
        out.say(fmt::format("{:<10} {:<16} {:7.2f} {:8.2f} {:6.2f} {:6.2f} {:7.2f} {:6.2f} {:7.0f} {:7.0f}", set.name,
                            b.model, b.ball_speed_rms, b.ball_speed_max, degrees(b.launch_angle_rms),
                            degrees(b.launch_angle_max), degrees(b.azimuth_rms), degrees(b.azimuth_max), spin_rms,
                            spin_max));
        page.rows.push_back({set.name, b.model, fmt::format("{:.2f}", b.ball_speed_rms),
                             fmt::format("{:.2f}", degrees(b.launch_angle_rms)),
                             fmt::format("{:.2f}", degrees(b.azimuth_rms)), fmt::format("{:.0f}", spin_rms)});
        csv += fmt::format("{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g}\n", post::csv_cell(set.name),
                           b.model, b.ball_speed_rms, b.ball_speed_max, degrees(b.launch_angle_rms),
                           degrees(b.launch_angle_max), degrees(b.azimuth_rms), degrees(b.azimuth_max), spin_rms,
                           spin_max);
        summary["sets"][set.name][b.model] = {{"ball_speed_rms_mps", b.ball_speed_rms},
                                              {"launch_angle_rms_deg", degrees(b.launch_angle_rms)},
                                              {"azimuth_rms_deg", degrees(b.azimuth_rms)},
                                              {"spin_rms_rpm", spin_rms}};
      }
      for (const std::string& parameter : fit.at_bound)
        out.warn(fmt::format("{}: {} is at an end of what the search allows", set.name, parameter));
      summary["at_bound"][set.name] = fit.at_bound;
      add(set, fit, fitted);
      toml += entry(set, fit);
    }
    progress.finish();
    out.page().answer(page);
    out.page().sentence(
        "How far each reduced model is from the finite elements that it was fitted to: root mean square "
        "over the blows of a set.");
    out.show(fitted, "The fitted parameters");
    out.write("bands.csv", csv);
    out.write("reduced.toml", toml);
    out.write_summary(summary);
  }

 private:
  static Set read_set(Table root, std::size_t index) {
    const std::vector<std::string> models{"fe-free-body"};
    Set set;
    Blow base = read_blow(root, models);
    set.fe = read_options(root, models, base).fe;
    // The head's own face is what a set without one is for, written or not.
    if (auto face = root.optional_table("face"); face && face->has("name")) {
      const std::string name = face->text({"name", "a face of the library (`hosel list`)"});
      Table club = root.table("head");
      const auto head = named_entry(club, "name", Shelf::heads);
      if (!head || library_head(*head).face != name) set.faces.push_back(name);
    }
    Table t = root.tables("sets")[index];
    set.name = t.text({"name", "of the set of parameters"});
    set.changes =
        t.texts({"set", "keys of the case that the set's club changes, table.key=value"}, std::vector<std::string>{});
    const auto speeds =
        t.quantities({"club_speeds", "of the grid, at the centre of the face"}, "mps", 0, limits::club_speed);
    set.lofts = t.quantities({"lofts", "of the grid"}, "deg", 0, limits::angle);
    const auto toes = t.quantities({"impact_toes", "of the strikes off centre, each with its height"}, "mm", 0,
                                   limits::impact_place, std::vector<double>{});
    t.decided_by("impact_toes_mm");
    const auto highs = t.quantities({"impact_highs", "of the same strikes"}, "mm", toes.size(), limits::impact_place,
                                    std::vector<double>(toes.size(), 0.0));
    if (speeds.empty() || set.lofts.empty()) t.fail("lofts", "a grid needs at least one speed and one loft");
    double speed = 0, loft = 0;
    for (const double v : speeds)
      for (const double l : set.lofts) {
        Blow& b = set.blows.emplace_back(base);
        b.delivery.club_speed = v;
        b.delivery.dynamic_loft = l;
        speed += v;
        loft += l;
      }
    const double n = double(set.blows.size());
    for (std::size_t k = 0; k < toes.size(); ++k) {
      Blow& b = set.blows.emplace_back(base);
      b.delivery.club_speed = speed / n;
      b.delivery.dynamic_loft = loft / n;
      b.delivery.impact_toe = toes[k];
      b.delivery.impact_high = highs[k];
    }
    if (set.blows.size() < 4) t.fail("lofts", "fewer than four blows tell nothing");
    return set;
  }

  /// A column of the set's parameters; the first set names the rows.
  static void add(const Set& set, const models::ReducedCalibration& fit, post::TextTable& table) {
    const models::VolumetricLaw& v = fit.volume;
    const std::vector<std::pair<std::string, double>> rows = {
        {"restitution", fit.law.restitution},
        {"restitution slope [s/m]", fit.law.restitution_slope},
        {"tangential restitution", fit.law.tangential_restitution},
        {"friction", fit.law.friction},
        {"volumetric: stiffness [N/m³]", v.stiffness},
        {"volumetric: damping [s/m]", v.damping},
        {"volumetric: transition speed [m/s]", v.transition_speed},
        {"volumetric: joint stiffness [N m]", v.joint_stiffness},
        {"volumetric: joint damping [N m s]", v.joint_damping},
        {"volumetric: cover thickness [mm]", 1e3 * v.cover_thickness},
        {"volumetric: exponent", v.volume_exponent},
        {"Hertz and Maw: modulus [MPa]", 1e-6 * fit.hertz.modulus},
        {"Hertz and Maw: Poisson's ratio", fit.hertz.poisson},
        {"Hertz and Maw: damping [s/m]", fit.hertz.damping}};
    if (table.rows.empty()) {
      table.rows = {{"parameter"}};
      for (const auto& [name, value] : rows) table.rows.push_back({name});
    }
    table.rows.front().push_back(set.name);
    for (std::size_t k = 0; k < rows.size(); ++k) table.rows[k + 1].push_back(fmt::format("{:.4g}", rows[k].second));
  }

  /// As a ball's entry of the library has it.
  static std::string entry(const Set& set, const models::ReducedCalibration& fit) {
    Use use = use_of(set.blows.front());
    for (const Blow& b : set.blows) use = both(use, use_of(b));
    const models::VolumetricLaw& v = fit.volume;
    std::string faces;
    for (const std::string& f : set.faces) faces += fmt::format("{}{}", faces.empty() ? "" : ", ", toml_text(f));
    return fmt::format(
        "\n[[reduced]]\nname = {}\n[reduced.saw]\nspin_loft_deg = [{:g}, {:g}]\n{}[reduced.contact]\n"
        "face_friction = {:.6g}\nrestitution = {:.6g}\nrestitution_slope_s_per_m = {:.6g}\n"
        "tangential_restitution = {:.6g}\nfriction = {:.6g}\nnormal_force_offset = 0\n[reduced.volumetric]\n"
        "stiffness_N_per_m3 = {:.6g}\ndamping_s_per_m = {:.6g}\nfriction = {:.6g}\ntransition_speed_mps = {:.6g}\n"
        "joint_stiffness_N_m_per_rad = {:.6g}\njoint_damping_N_m_s_per_rad = {:.6g}\ncover_thickness_mm = {:.6g}\n"
        "volume_exponent = {:.6g}\n[reduced.hertz_maw]\nmodulus_MPa = {:.6g}\npoisson = {:.6g}\nfriction = {:.6g}\n"
        "damping_s_per_m = {:.6g}\n",
        toml_text(set.name), degrees(use.spin_loft.low), degrees(use.spin_loft.high),
        faces.empty() ? "" : fmt::format("faces = [{}]\n", faces), fit.law.friction, fit.law.restitution,
        fit.law.restitution_slope, fit.law.tangential_restitution, fit.law.friction, v.stiffness, v.damping, v.friction,
        v.transition_speed, v.joint_stiffness, v.joint_damping, 1e3 * v.cover_thickness, v.volume_exponent,
        1e-6 * fit.hertz.modulus, fit.hertz.poisson, fit.hertz.friction, fit.hertz.damping);
  }

  std::vector<Set> sets_;
};

}  // namespace

std::unique_ptr<Job> read_calibrate_reduced(CaseFile& file) { return std::make_unique<CalibrateReducedJob>(file); }

}  // namespace hosel::app
