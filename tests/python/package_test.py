"""The Python package: what it computes is what the command computes, and bad input is an error with a sentence."""

import contextlib
import ctypes
import importlib.util
import os
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
import time
import unittest
import unittest.mock
import warnings
from pathlib import Path

import numpy as np

import hosel

FAST = ['models=["rigid-eccentric"]']
ROOT = Path(__file__).resolve().parents[2]
# A flat face, and nothing from the library.
BLOW = """kind = "impact"
models = ["rigid-eccentric"]
[delivery]
club_speed_mps = 45.0
dynamic_loft_deg = 10.0
[head]
mass_kg = 0.2
cg_mm = [-35.0, 0.0, 0.0]
inertia_kg_m2 = [[3.7e-4, 0, 0], [0, 2.9e-4, 0], [0, 0, 4.8e-4]]
"""
# The first blow is an everyday one; the model gives the second more energy than it had.
OFFSET = ["contact.normal_force_offset=0.3"]
LOFTS = [10.0, -40.0]


@contextlib.contextmanager
def meanwhile(work):
    """Calls work() again and again in another thread."""
    done = threading.Event()

    def go_on():
        while not done.is_set():
            work()
            time.sleep(0.001)

    thread = threading.Thread(target=go_on)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


class InFolder(unittest.TestCase):
    """A folder of its own, and in it the case `blow`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name).resolve()
        self.out = self.folder / "out"
        self.blow = self.folder / "blow"
        self.blow.mkdir()
        (self.blow / "case.toml").write_text(BLOW)

    def table(self, text, encoding="utf-8"):
        (self.folder / "t.csv").write_bytes(text.encode(encoding))
        return hosel.read_table(self.folder / "t.csv")

    def many_points(self, name):
        """A study of 4,000 blows, as the case NAME."""
        values = [k / 10 for k in range(100)]
        (self.folder / name).mkdir()
        (self.folder / name / "case.toml").write_text(
            'kind = "study"\ncase = "../blow"\noutputs = ["models.rigid-eccentric.ball_speed_mps"]\n'
            f'[[axis]]\nkey = "delivery.impact_toe_mm"\nvalues = {values}\n'
            f'[[axis]]\nkey = "delivery.impact_high_mm"\nvalues = {values[:40]}\n')
        return self.folder / name


class Launches(InFolder):
    def test_an_array_of_blows_is_each_blow_by_itself(self):
        model = hosel.Model("driver-toe", "rigid-eccentric")
        toe = np.array([[-20.0, 0.0], [10.0, 20.0]])
        all_at_once = model.launch(club_speed_mph=100.0, impact_toe_mm=toe)
        self.assertEqual(all_at_once["sidespin_rpm"].shape, (2, 2))
        # Something happened: a toe blow draws, a heel blow fades.
        self.assertLess(all_at_once["sidespin_rpm"][1, 1], -100)
        self.assertGreater(all_at_once["sidespin_rpm"][0, 0], 100)
        for i in np.ndindex(toe.shape):
            one = model.launch(club_speed_mps=100 * 0.44704, impact_toe_mm=toe[i])
            for name, values in all_at_once.items():
                self.assertAlmostEqual(values[i], float(one[name]), delta=1e-9 * (1 + abs(values[i])), msg=name)

    def test_a_blow_off_the_face_is_told(self):
        model = hosel.Model("driver-toe", "rigid-eccentric")
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            model.launch(impact_toe_mm=[0, 20])
            self.assertEqual(told, [])
            model.launch(impact_toe_mm=[0, 20, 95])
        self.assertEqual(len(told), 1)
        self.assertIn("1 of 3 blows; the first is blow 2: the ball is struck off the face: 95 mm towards the toe",
                      str(told[0].message))

    def test_the_model_is_the_commands(self):
        said = hosel.run("driver-toe", self.out, set=FAST).launches()["rigid-eccentric"]
        asked = hosel.Model("driver-toe", "rigid-eccentric").launch()
        self.assertGreater(said["ball_speed_mps"], 50)
        for name in asked:
            self.assertAlmostEqual(float(asked[name]), said[name], delta=1e-9 * (1 + abs(said[name])), msg=name)

    def test_each_blow_has_the_parameters_that_the_command_takes(self):
        lofts, said, stiffness = [12.0, 20.0, 30.0], [], set()
        for loft in lofts:
            run = hosel.run("driver-toe", self.folder / f"{loft}",
                            set=['models=["volumetric"]', f"delivery.dynamic_loft_deg={loft}"])
            said.append(run.launches()["volumetric"])
            stiffness.add(run.case["volumetric"]["stiffness_N_per_m3"])
        self.assertEqual(len(stiffness), 3)  # the ball has another set for each of these lofts
        model = hosel.Model("driver-toe", "volumetric")
        together = model.launch(dynamic_loft_deg=lofts)
        for name, values in together.items():
            for i, loft in enumerate(lofts):
                self.assertEqual(values[i], said[i][name], msg=f"{name} at {loft} deg")
                self.assertEqual(float(model.launch(dynamic_loft_deg=loft)[name]), said[i][name])

    def test_a_blow_that_the_command_refuses_is_refused(self):
        refused = "ball.model: 'tour' has several sets of parameters and none of them saw this loft"
        with self.assertRaisesRegex(hosel.InputError, refused):
            hosel.run("driver-toe", self.out, set=FAST + ["delivery.dynamic_loft_deg=45"])
        for name in ("rigid-eccentric", "volumetric"):
            model = hosel.Model("driver-toe", name)
            self.assertGreater(float(model.launch(dynamic_loft_deg=43)["ball_speed_mps"]), 20)
            with self.assertRaisesRegex(hosel.InputError, f"blow 1: .*{refused}"):
                model.launch(dynamic_loft_deg=[43, 45])

    def test_a_swung_club_is_refused(self):
        with self.assertRaisesRegex(hosel.InputError, "motion: a swing delivers the club here.*hosel.run"):
            hosel.Model("loaded-club/blow", "shaft-coupled")

    def test_a_loft_that_is_sought_is_refused(self):
        sought = ["matched_launch=true", "measured.launch_angle_deg=12"]
        self.assertTrue(hosel.check("driver-toe", set=sought)["matched_launch"])  # the case itself is whole
        with self.assertRaisesRegex(hosel.InputError, "matched_launch: the loft of each blow"):
            hosel.Model("driver-toe", "rigid-eccentric", set=sought)

    def test_what_is_stable_is_what_is_offered(self):
        page = ROOT / "docs" / "stability.md"
        row = next(line for line in page.read_text().splitlines() if "`hosel.__all__`" in line)
        self.assertGreater(len(hosel.__all__), 5)
        self.assertEqual(sorted(row.split("lists:")[1].replace("`", "").strip(" |").split(", ")), sorted(hosel.__all__))

    def test_a_table_prints_short(self):
        table = hosel.Table(club=np.array(["7i"] * 9), spin_rpm=np.arange(9.0))
        self.assertEqual(repr(table), "hosel.Table of 9 rows\n  club      7i, 7i, 7i, ..., 7i\n  spin_rpm  0, 1, 2, ..., 8")

    def test_bad_input_is_named(self):
        model = hosel.Model("driver-toe", "rigid-eccentric")
        for inputs, words in [({"club_sped_mph": 1.0}, "club_sped_mph"),
                              ({"club_speed_deg": 1.0}, "'club_speed_deg' has no unit of speed: .*club_speed_mph"),
                              ({"club_speed": 1.0}, "'club_speed' has no unit of speed: .*club_speed_mps"),
                              ({"dynamic_loft_deg": [10.0, 179.0]}, "blow 1")]:
            with self.assertRaisesRegex(ValueError, words):
                model.launch(**inputs)
        for inputs, words in [({"club_speed_mph": 100.0, "club_speed_mps": 40.0}, "club_speed is given twice"),
                              ({"dynamic_loft_deg": [10.0, 370.0]}, "blow 1: dynamic_loft_deg: 370 is out of range"),
                              ({"head_mass_kg": 1e9}, "head_mass_kg: 1e\\+09 is out of range"),
                              ({"club_speed_mps": float("nan")}, "out of range")]:
            with self.assertRaisesRegex(hosel.InputError, words):
                model.launch(**inputs)
        with self.assertRaisesRegex(ValueError, "2 names, so a table of as many columns"):
            model._model.launch(["club_speed_mps", "head_mass_kg"], np.zeros((3, 1)))
        with self.assertRaisesRegex(ValueError, "did you mean"):
            hosel.Model("driver-to")
        with self.assertRaisesRegex(hosel.InputError, "head.mass_kg"):
            hosel.check("driver-toe", set=["head.mass_kg=200"])


class Studies(InFolder):
    TOE, SPEED = "delivery.impact_toe_mm", "delivery.club_speed_mph"
    BALL, SIDE = "models.rigid-eccentric.ball_speed_mps", "models.rigid-eccentric.sidespin_rpm"

    def setUp(self):
        super().setUp()
        self.study = hosel.Study("driver-toe", set=FAST, outputs=[self.BALL, self.SIDE])
        self.model = hosel.Model("driver-toe", "rigid-eccentric")

    def compare(self, found, name, launch):
        self.assertGreater(np.ptp(found.array[name]), 1)  # the inputs did something
        np.testing.assert_allclose(found.array[name], launch[name.split(".")[-1]], rtol=1e-9)

    def test_a_grid_is_each_blow_by_itself(self):
        toe, speed = [-20.0, 0.0, 15.0], [95.0, 105.0]
        found = self.study.grid(self.out, {self.TOE: toe, self.SPEED: speed})
        self.assertEqual(found.dims, (self.TOE, self.SPEED))
        self.assertEqual(found.outputs, [self.BALL, self.SIDE])
        self.assertTrue((found.errors == "").all())
        launch = self.model.launch(impact_toe_mm=np.array(toe)[:, None], club_speed_mph=speed)
        for name in found.outputs:
            self.compare(found, name, launch)
            np.testing.assert_array_equal(np.asarray(found[name]), found.array[name])
        with self.assertRaisesRegex(hosel.InputError, "finished run"):
            self.study.grid(self.out, {self.TOE: toe})
        with self.assertRaisesRegex(KeyError, "sidespin"):
            found["sidespin"]

    def test_rows_and_a_sample_have_their_inputs_beside_them(self):
        toe, speed = [-20.0, 5.0, 15.0], [90.0, 100.0, 110.5]
        found = self.study.rows(self.out, {self.TOE: toe, self.SPEED: speed})
        self.compare(found, self.SIDE, self.model.launch(impact_toe_mm=toe, club_speed_mph=speed))
        np.testing.assert_array_equal(found.coords[self.SPEED], speed)
        found = self.study.sample(self.out.with_name("sample"), {self.TOE: (-20, 20)}, points=9, seed=3)
        self.assertEqual(found.array.shape, (9,))
        self.compare(found, self.SIDE, self.model.launch(impact_toe_mm=found.coords[self.TOE]))

    def test_axes_are_labelled_where_xarray_is(self):
        try:
            import xarray
        except ImportError:
            self.skipTest("no xarray (python3-xarray)")
        found = self.study.grid(self.out, {self.TOE: [-20.0, 20.0], self.SPEED: [95.0, 105.0, 115.0]})[self.SIDE]
        self.assertIsInstance(found, xarray.DataArray)
        self.assertGreater(float(found.sel({self.TOE: -20, self.SPEED: 105})), 100)
        self.assertLess(float(found.sel({self.TOE: 20, self.SPEED: 105})), -100)

    def test_what_cannot_be_is_said(self):
        for columns, words in [({"delivery.impact_to_mm": [1.0]}, "did you mean 'impact_toe_mm'"),
                               ({self.TOE: [1.0, 2.0], self.SPEED: [90.0]}, "one length"),
                               ({self.TOE: [1.0, None, 2.0]}, "a point has no value"),
                               ({self.TOE: np.ma.masked_array([1.0, 2.0], mask=[0, 1])}, "a point has no value"),
                               ({self.TOE: [1.0], "title": ['a "b",\n\\c']}, "rows.csv")]:
            with self.assertRaisesRegex(ValueError, words):
                self.study.rows(self.out, columns)
        with self.assertRaisesRegex(ValueError, "blow 2|nan"):
            self.model.launch(club_speed_mph=np.ma.masked_array([100.0, 20.0], mask=[0, 1]))


class Points(InFolder):
    BALL = "models.rigid-eccentric.ball_speed_mps"

    def test_a_point_without_an_answer_is_nan_with_its_reason(self):
        study = hosel.Study(self.blow, set=OFFSET, outputs=[self.BALL])
        found = study.rows(self.out, {"delivery.dynamic_loft_deg": LOFTS})
        self.assertGreater(found.array[self.BALL][0], 40)
        self.assertEqual(found.errors[0], "")
        self.assertTrue(np.isnan(found.array[self.BALL][1]))
        self.assertRegex(found.errors[1], "more energy than the blow")
        self.assertEqual(found.run.summary["failed"], 1)

    def test_an_entry_that_a_point_lacks_is_nan(self):
        ratio, angles = "models.rigid-eccentric.launch_ratio", {"delivery.attack_angle_deg": [0.0, 10.0]}
        found = hosel.Study(self.blow).grid(self.out, angles)  # where loft equals attack angle the ratio is of nothing
        self.assertGreater(found.array[ratio][0], 0.5)
        self.assertTrue(np.isnan(found.array[ratio][1]))
        self.assertGreater(found.array[self.BALL][1], 40)
        self.assertTrue((found.errors == "").all())
        with self.assertRaisesRegex(hosel.InputError, "point 1 has no number 'models.rigid-eccentric.launch_ratio'"):
            hosel.Study(self.blow, outputs=[ratio]).grid(self.folder / "named", angles)

    def test_points_have_names(self):
        toe = "delivery.impact_toe_mm"
        found = hosel.Study(self.blow, outputs=[self.BALL]).rows(self.out, {"name": ["heel", "toe"], toe: [-10.0, 20.0]})
        self.assertEqual(list(found.coords["name"]), ["heel", "toe"])
        self.assertEqual(list(found.coords[toe]), [-10, 20])
        self.assertEqual(found.outputs, [self.BALL])

    def test_a_bare_text_is_no_list(self):
        for wrong in (lambda: hosel.Study(self.blow, outputs=self.BALL), lambda: hosel.Study(self.blow, set=FAST[0]),
                      lambda: hosel.Model(self.blow, set=FAST[0]), lambda: hosel.check(self.blow, set=FAST[0]),
                      lambda: hosel.run(self.blow, self.out, set=FAST[0])):
            with self.assertRaisesRegex(TypeError, "a list of texts"):
                wrong()
        self.assertFalse(self.out.exists())

    def test_a_blow_that_does_not_converge_is_no_bad_input(self):
        model = hosel.Model(self.blow, set=OFFSET)
        self.assertGreater(float(model.launch()["ball_speed_mps"]), 40)
        with self.assertRaisesRegex(hosel.NonConvergence, "blow 1: the answer has more energy"):
            model.launch(dynamic_loft_deg=LOFTS)

    def test_missing_data_are_said(self):
        with unittest.mock.patch.dict(os.environ, HOSEL_DATA="/nowhere"):
            with self.assertWarnsRegex(UserWarning, "radar-law: skipped, /nowhere/.*HOSEL_DATA"):
                run = hosel.run("radar-law", self.out)
            self.assertRegex(run.skipped, "^/nowhere/")
            with self.assertRaisesRegex(FileNotFoundError, "/nowhere/.*HOSEL_DATA"):
                hosel.Study("radar-law").grid(self.folder / "study", {"paths.noise_m": [3.0, 4.0]})
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertIsNone(hosel.run(self.blow, self.folder / "whole").skipped)


class Process(InFolder):
    """What a run leaves behind in the process that called it."""

    def test_control_c_stops_this_run_and_no_other(self):
        many, before, sent = self.many_points("many"), signal.getsignal(signal.SIGINT), []

        def interrupt():
            points = [f.read_bytes().count(b"\n") for f in self.out.glob("shards/*/points.jsonl")]
            if not sent and sum(points) > 1:
                sent.append(os.kill(os.getpid(), signal.SIGINT))

        with self.assertRaises(KeyboardInterrupt), meanwhile(interrupt):
            hosel.run(many, self.out)
        self.assertFalse((self.out / "summary.json").exists())  # stopped on its way
        self.assertEqual(signal.getsignal(signal.SIGINT), before)
        self.assertEqual(hosel.run(many, self.out).summary["points"], 4000)
        self.assertIn("points are on disk already", (self.out / "log.txt").read_text())

    def test_other_threads_work_while_a_case_is_read(self):
        many, ticks = self.many_points("many"), []
        with meanwhile(lambda: ticks.append(time.perf_counter())):
            start = time.perf_counter()
            hosel.check(many)
            end = time.perf_counter()
        self.assertGreater(end - start, 0.05)
        # Who holds the interpreter makes one gap of the whole reading; a busy machine makes some, none half as long.
        self.assertLess(max(np.diff([start, *(t for t in ticks if start < t < end), end])), 0.5 * (end - start))

    def test_linear_algebra_has_its_threads_again(self):
        try:
            blas = ctypes.CDLL("libopenblas.so.0")
        except OSError:
            self.skipTest("no OpenBLAS")
        before = blas.openblas_get_num_threads()
        self.addCleanup(blas.openblas_set_num_threads, before)
        blas.openblas_set_num_threads(2)
        if blas.openblas_get_num_threads() != 2:
            self.skipTest("an OpenBLAS of one thread")
        seen = set()
        with meanwhile(lambda: seen.add(blas.openblas_get_num_threads())):
            hosel.run(self.many_points("many"), self.out)
        self.assertIn(1, seen)
        self.assertEqual(blas.openblas_get_num_threads(), 2)


class Backend(InFolder):
    def compiled(self, configured_for, module=True):
        """The first words of the commands by which a wheel is built in a folder that was configured so."""
        path = ROOT / "python" / "backend.py"
        if not path.exists():
            self.skipTest("no sources")
        spec = importlib.util.spec_from_file_location("backend", path)
        backend = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(backend)
        build = self.folder / "build"
        (build / "python" / "hosel").mkdir(parents=True, exist_ok=True)
        file = build / "python" / "hosel" / f"_hosel{sysconfig.get_config_var('EXT_SUFFIX')}"
        file.write_bytes(b"")
        if not module:
            file.unlink()
        (build / "CMakeCache.txt").write_text(f"CMAKE_BUILD_TYPE:STRING=Release\nPython_EXECUTABLE:FILEPATH={configured_for}\n")
        with unittest.mock.patch.dict(os.environ, HOSEL_BUILD=str(build)), \
             unittest.mock.patch.object(subprocess, "run") as run:
            self.assertEqual(backend._compiled(), file)
        return [call.args[0][1] for call in run.call_args_list]

    def test_a_folder_of_another_interpreter_is_configured_again(self):
        self.assertEqual(self.compiled("/usr/bin/python3.99"), ["--preset", "--build"])
        self.assertEqual(self.compiled(os.path.realpath(sys.executable), module=False), ["--preset", "--build"])
        self.assertEqual(self.compiled(os.path.realpath(sys.executable)), ["--build"])


class Results(InFolder):
    def test_where_asks_for_what_a_column_holds(self):
        table = self.table("variant,x\n1,1\n2,2\n")
        self.assertEqual(list(table.where(variant=2)["x"]), [2])
        with self.assertRaisesRegex(KeyError, "no column 'y' .there are variant, x"):
            table["y"]
        with self.assertRaisesRegex(ValueError, "'variant' holds numbers"):
            table.where(variant="1")
        with self.assertRaisesRegex(ValueError, "takes one value, not 2"):
            table.where(variant=[1, 2])
        table = self.table("name,x\n'+5 g,1\n' =b,2\n'quoted',3\n")
        self.assertEqual(list(table.name), ["+5 g", " =b", "'quoted'"])
        self.assertEqual(list(table.where(name="+5 g")["x"]), [1])
        with self.assertRaisesRegex(ValueError, "'name' holds texts"):
            table.where(name=5)
        table = self.table("name,x\n1_000,-1.5e-3\n2_000,+.5\n")
        self.assertEqual(list(table.where(name="1_000")["x"]), [-1.5e-3])
        self.assertEqual(table.x[1], 0.5)
        table = self.table("name,error\ninf,\nnan,\n-1e400,\n")  # numbers, as hosel writes them
        self.assertEqual(table.name.dtype.kind, "f")
        self.assertEqual(len(table.where(error="any")["name"]), 0)

    def test_what_is_no_table_is_said(self):
        self.assertEqual(list(self.table("\ufeffx_mm,wer\n1,Jörg\n")), ["x_mm", "wer"])
        self.assertEqual(self.table("x_mm,wer\n1,Jörg\n").wer[0], "Jörg")
        for text, words in [("a,b\n1,2\n1,2,3\n", ":3: 3 cells where the header has 2"), ("a,b\n1\n", ":2: 1 cells"),
                            ("a,a\n1,2\n", ":1: column 'a' stands twice"), ("", ":1: no header")]:
            with self.assertRaisesRegex(ValueError, "t.csv" + words):
                self.table(text)
        with self.assertRaises(ValueError):
            self.table("a\nJörg\n", "latin-1")

    def test_a_run_is_found_from_another_directory(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        run = hosel.run(self.blow, "out")
        os.chdir("/")
        self.assertIn("error", hosel.Study(self.blow).grid(self.folder / "s", {"delivery.impact_toe_mm": [0, 1]}).run["points.csv"])
        self.assertTrue(run.directory.samefile(self.out))
        self.assertEqual(repr(run), f"hosel.Run({str(self.out)!r})")

    def test_a_run_is_read_back(self):
        hosel.run("face-map-driver-reduced", self.out, set=["grid.columns=5", "grid.rows=3"])
        run = hosel.read(self.out)
        self.assertEqual(run.case["grid"]["columns"], 5)
        self.assertIn("face_map.csv", run.tables)
        table = run["face_map.csv"]
        models = np.unique(table["model"])
        xs, ys, speed = table.where(model=models[0]).grid("impact_toe_mm", "impact_high_mm", "ball_speed_mps")
        self.assertEqual(speed.shape, (3, 5))
        self.assertTrue(np.isfinite(speed).all() and speed.min() > 40)
        with self.assertRaisesRegex(ValueError, "twice"):
            table.grid("impact_toe_mm", "impact_high_mm", "ball_speed_mps")
        with self.assertRaisesRegex(KeyError, "face_map.csv"):
            run["nothing.csv"]
        with self.assertRaisesRegex(ValueError, "finished"):  # as the command: not without force
            hosel.run("face-map-driver-reduced", self.out)

    def test_a_forced_run_leaves_nothing_of_the_one_before(self):
        before = hosel.run("driver-toe", self.out, set=['models=["fe-free-body"]', "accuracy=look"])
        self.assertIn("history.csv", before.tables)
        self.assertGreater(len(before.figures), 2)
        self.assertGreater(len(list(self.out.rglob("*.vtp"))), 10)
        (self.out / "notes.csv").write_text("mine\n1\n")
        (self.out / "vtk/ball/mine.vtu").write_text("mine")
        run = hosel.run(self.blow, self.out, force=True)  # draws nothing and has no table
        with self.assertRaisesRegex(KeyError, "history.csv"):
            run["history.csv"]
        self.assertEqual((run.tables, run.figures), (["notes.csv"], []))
        self.assertEqual([f.name for f in (self.out / "vtk").rglob("*")], ["ball", "mine.vtu"])

    def test_what_a_killed_run_left_unfinished_is_removed(self):
        for folder in ("1-1.unfinished", "figures/1-2.unfinished", "shards/1-3.unfinished"):
            (self.out / folder).mkdir(parents=True)
            (self.out / folder / "flight.png").write_text("half")
        hosel.run(self.blow, self.out)
        self.assertEqual([f.name for f in self.out.rglob("*.unfinished")], ["1-3.unfinished"])  # another process's

    def test_a_list_of_files_names_none_elsewhere(self):
        hosel.run(self.blow, self.out)
        old = (self.out / ".written").read_text()
        self.assertIn("case.resolved.toml\n", old)
        for name in ("victim", "out/below"):
            (self.folder / name).write_text("years")
        (self.out / ".written").write_text(f"../victim\n{self.folder}/victim\nfigures/../../victim\nbelow\n\n.\n")
        hosel.run(self.blow, self.out, force=True)
        self.assertEqual((self.folder / "victim").read_text(), "years")
        self.assertFalse((self.out / "below").exists())  # the list is obeyed
        self.assertEqual((self.out / ".written").read_text(), old)

    def test_an_empty_cell_is_nan_and_a_word_stays_a_word(self):
        table = self.table("x_mm,who\n1.5,a\n,b\n")
        self.assertEqual(table.x_mm[0], 1.5)
        self.assertTrue(np.isnan(table.x_mm[1]))
        self.assertEqual(list(table.who), ["a", "b"])

    def test_a_directory_without_a_run_is_said(self):
        with self.assertRaisesRegex(FileNotFoundError, "no finished run"):
            hosel.read("/nowhere")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
