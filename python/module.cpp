// The compiled half of `import hosel`: cases read and run by the same code as the command's, and one model asked about
// many blows at once. Docstrings for people stand in python/hosel.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <csignal>
#include <new>

#include "app/asked_model.hpp"
#include "app/cases.hpp"
#include "app/job.hpp"
#include "app/read_blow.hpp"
#include "app/stop.hpp"
#include "build_info.hpp"
#include "golf/quantities.hpp"
#include "post/launch_table.hpp"
#include "solvers/blas.hpp"
#include "solvers/errors.hpp"

namespace py = pybind11;
using namespace hosel;

namespace {

using Texts = std::vector<std::string>;

void run(const std::string& where, const std::filesystem::path& out, const Texts& set, bool force, bool quiet) {
  app::StopSignals::too_late();  // of an earlier run, which ended with an error
  app::CaseFile file(app::find_case(where), set);
  const auto job = app::read_job(file);
  app::Output output({.directory = out, .force = force, .quiet = quiet}, file);
  job->run(output);
  if (const int signal = app::StopSignals::too_late()) std::raise(signal);
}

std::string check(const std::string& where, const Texts& set) {
  app::CaseFile file(app::find_case(where), set);
  app::read_job(file);
  return file.resolved();
}

/// The blow of a case and one model, asked again and again with other inputs.
class Model {
 public:
  Model(const std::string& where, const std::string& name, const Texts& set) : model_(where, name, set) {}

  const std::string& name() const { return model_.name(); }

  /// Columns of `inputs` are named by `names`, each with its unit; rows are blows. Columns of the result: channels().
  py::array_t<double> launch(const Texts& names, const py::array_t<double, py::array::c_style>& inputs) const {
    if (inputs.ndim() != 2 || inputs.shape(1) != py::ssize_t(names.size()))
      throw app::InputError(fmt::format("{} names, so a table of as many columns is wanted", names.size()));
    std::vector<Input> asked;  // of the columns
    std::vector<double> si;
    for (const std::string& name : names) {
      const SplitName split = split_unit(name);
      const std::optional<Input> input = input_of(split.stem);
      if (!input || !split.unit || split.unit->dimension != quantity(*input).dimension)
        throw app::InputError(unknown(name));
      if (std::ranges::count(asked, *input))
        throw app::InputError(fmt::format("'{}': {} is given twice, in two units", name, stem(*input)));
      asked.push_back(*input);
      si.push_back(split.unit->si);
    }
    const auto in = inputs.unchecked<2>();
    std::vector<double> values;
    // As in a case: a value outside what the reader allows is an error, and the first one is named.
    for (py::ssize_t i = 0; i < in.shape(0); ++i)
      for (std::size_t c = 0; c < asked.size(); ++c) {
        const app::Range range = app::limits::of(asked[c]);
        const double x = in(i, py::ssize_t(c));
        values.push_back(x * si[c]);
        if (!range.contains(values.back()))
          throw app::InputError(
              fmt::format("blow {}: {}: {:g} is {}", i, names[c], x, range.sentence(split_unit(names[c]).unit)));
      }
    if (const std::string doubt = model_.doubt(std::size_t(in.shape(0)), asked, values);
        !doubt.empty() && PyErr_WarnEx(PyExc_UserWarning, doubt.c_str(), 2) != 0)
      throw py::error_already_set();
    std::vector<models::Answer> launches;
    {
      const py::gil_scoped_release released;
      const solvers::BlasThreads before;
      launches = model_.launches(std::size_t(in.shape(0)), asked, values);
    }
    const auto channels = post::channels();
    py::array_t<double> answers({in.shape(0), py::ssize_t(channels.size())});
    auto out = answers.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < in.shape(0); ++i) try {
        const Launch& launch = launches[std::size_t(i)].value();
        for (std::size_t c = 0; c < channels.size(); ++c)
          out(i, py::ssize_t(c)) = (launch.*channels[c].value)() / channels[c].si;
      } catch (const std::bad_alloc&) { throw; } catch (const solvers::NonConvergence& e) {
        throw solvers::NonConvergence(fmt::format("blow {}: {}", i, e.what()));
      } catch (const std::exception& e) { throw app::InputError(fmt::format("blow {}: {}", i, e.what())); }
    return answers;
  }

  static Texts channels() {
    Texts out;
    for (const post::Channel& c : post::channels()) out.push_back(fmt::format("{}_{}", c.name, c.unit));
    return out;
  }

 private:
  static std::string unknown(const std::string& name) {
    Texts known;
    if (const auto input = input_of(split_unit(name).stem)) {
      for (const Unit& u : units())
        if (u.dimension == quantity(*input).dimension) known.push_back(fmt::format("{}_{}", stem(*input), u.suffix));
      return fmt::format("'{}' has no unit of {}: {}", name, hosel::name(quantity(*input).dimension),
                         fmt::join(known, ", "));
    }
    for (int i = 0; i < kInputs; ++i) known.emplace_back(stem(static_cast<Input>(i)));
    return fmt::format("'{}' is no input of a blow (known, each with a unit behind it: {})", name,
                       fmt::join(known, ", "));
  }

  app::AskedModel model_;
};

}  // namespace

PYBIND11_MODULE(_hosel, m) {
  py::register_exception<app::InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<solvers::NonConvergence>(m, "NonConvergence", PyExc_RuntimeError);
  // Ctrl-C, as Python has it; a SIGTERM stays a RuntimeError.
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const app::Stopped& e) {
      PyErr_SetString(e.signal() == SIGINT ? PyExc_KeyboardInterrupt : PyExc_RuntimeError, e.what());
    }
  });
  m.attr("__version__") = HOSEL_VERSION;
  using Alone = py::call_guard<py::gil_scoped_release, solvers::BlasThreads>;
  m.def("run", run, Alone());
  m.def("check", check, Alone());
  py::class_<Model>(m, "Model")
      .def(py::init<const std::string&, const std::string&, const Texts&>(), Alone())
      .def_property_readonly("name", &Model::name)
      .def("launch", &Model::launch)
      .def_static("channels", &Model::channels);
}
