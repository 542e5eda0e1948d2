"""The Python package: what it computes is what the command computes, and bad input is an error with a sentence."""

import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import hosel

FAST = ['models=["rigid-eccentric"]']


class Launches(unittest.TestCase):
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

    def test_the_model_is_the_commands(self):
        with tempfile.TemporaryDirectory() as folder:
            run = hosel.run("driver-toe", Path(folder) / "out", set=FAST)
            said = run.launches()["rigid-eccentric"]
        asked = hosel.Model("driver-toe", "rigid-eccentric").launch()
        self.assertGreater(said["ball_speed_mps"], 50)
        for name in asked:
            self.assertAlmostEqual(float(asked[name]), said[name], delta=1e-9 * (1 + abs(said[name])), msg=name)

    def test_each_blow_has_the_parameters_that_the_command_takes(self):
        lofts, said, stiffness = [12.0, 20.0, 30.0], [], set()
        with tempfile.TemporaryDirectory() as folder:
            for loft in lofts:
                run = hosel.run("driver-toe", Path(folder) / f"{loft}",
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
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(hosel.InputError, refused):
                hosel.run("driver-toe", Path(folder) / "out", set=FAST + ["delivery.dynamic_loft_deg=45"])
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
        page = Path(__file__).resolve().parents[2] / "docs" / "stability.md"
        row = next(line for line in page.read_text().splitlines() if "`hosel.__all__`" in line)
        self.assertGreater(len(hosel.__all__), 5)
        self.assertEqual(sorted(row.split("lists:")[1].replace("`", "").strip(" |").split(", ")), sorted(hosel.__all__))

    def test_a_table_prints_short(self):
        table = hosel.Table(club=np.array(["7i"] * 9), spin_rpm=np.arange(9.0))
        self.assertEqual(repr(table), "hosel.Table of 9 rows\n  club      7i, 7i, 7i, ..., 7i\n  spin_rpm  0, 1, 2, ..., 8")

    def test_bad_input_is_named(self):
        model = hosel.Model("driver-toe", "rigid-eccentric")
        for inputs, words in [({"club_sped_mph": 1.0}, "club_sped_mph"), ({"club_speed_deg": 1.0}, "club_speed_deg"),
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


class Studies(unittest.TestCase):
    TOE, SPEED = "delivery.impact_toe_mm", "delivery.club_speed_mph"
    BALL, SIDE = "models.rigid-eccentric.ball_speed_mps", "models.rigid-eccentric.sidespin_rpm"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name) / "out"
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
                               ({self.TOE: [1.0], "title": ['a "b",\n\\c']}, "rows.csv")]:
            with self.assertRaisesRegex(ValueError, words):
                self.study.rows(self.out, columns)


class Results(unittest.TestCase):
    def test_a_run_is_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "map"
            hosel.run("face-map-driver-reduced", out, set=["grid.columns=5", "grid.rows=3"])
            run = hosel.read(out)
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
                hosel.run("face-map-driver-reduced", out)

    def test_an_empty_cell_is_nan_and_a_word_stays_a_word(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "t.csv"
            file.write_text("x_mm,who\n1.5,a\n,b\n")
            table = hosel.read_table(file)
        self.assertEqual(table.x_mm[0], 1.5)
        self.assertTrue(np.isnan(table.x_mm[1]))
        self.assertEqual(list(table.who), ["a", "b"])

    def test_a_directory_without_a_run_is_said(self):
        with self.assertRaisesRegex(FileNotFoundError, "no finished run"):
            hosel.read("/nowhere")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
