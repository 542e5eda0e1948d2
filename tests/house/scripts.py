#!/usr/bin/env python3
"""The scripts that check this project find what they are there for: each on a small input that is made up here."""
import contextlib
import importlib.machinery
import importlib.util
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = ROOT / "scripts"


def module(name):
    """A script without a suffix, as a module."""
    loader = importlib.machinery.SourceFileLoader(name.replace("-", "_"), str(SCRIPTS / name))
    made = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    sys.modules[loader.name] = made
    loader.exec_module(made)
    return made


def run(*words, **environment):
    """Status and all that is said."""
    done = subprocess.run([str(w) for w in words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, env=os.environ | {k: str(v) for k, v in environment.items()})
    return done.returncode, done.stdout


class Test(unittest.TestCase):
    def setUp(self):
        self.at = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def file(self, name, text, program=False):
        path = self.at / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        if program:
            path.chmod(0o755)
        return path


class Figures(Test):
    def page(self, text):
        figures = module("check-figures")
        figures.ROOT = self.at
        readme = self.file("README.md", text)
        with contextlib.redirect_stdout(io.StringIO()):
            return figures.Page(readme, figures.Runner(self.at / "scratch", "hosel", True), False)

    def test_a_number_is_compared_whatever_its_column_is_called_that_holds_nobody_elses(self):
        table = "<!-- figures: echo 1.00 0.83 -->\n| | {} |\n|---|---|\n| holds | 1.00 |\n| holds here | 0.23 |\n"
        for head in ("share of the range in which it holds", "outside the law's range", "unmeasured"):
            page = self.page(table.format(head))
            self.assertEqual(page.count["compared"], 2, head)
            self.assertEqual(len(page.wrong), 1, head)

    def test_what_others_found_is_left_out(self):
        for head in ("measured", "spin, measured", "reference: the same four", "motion capture and camera", "plausible range", "a - b"):
            page = self.page(f"<!-- figures: echo 7 -->\n| | a | {head} |\n|---|---|---|\n| x | 7 | 8 |\n")
            self.assertEqual((page.count["compared"], page.wrong), (1, []), head)

    def test_a_comment_with_no_number_below_it_is_a_failure(self):
        for below in ("\n| | a |\n|---|---|\n| x | 7 |\n", "| | measured |\n|---|---|\n| x | 7 |\n", "Words.\n", ""):
            for kind in ("", " slow", " none"):
                page = self.page(f"<!-- figures{kind}: echo 7 -->\n{below}")
                self.assertEqual(len(page.wrong), 1, (kind, below))


class Validation(Test):
    def setUp(self):
        super().setUp()
        self.script = module("write-validation")
        self.rows = [{"what": "speed [m/s]", "reference": 50.0, "at": "a/speed", "data": "1 %"}]

    def say(self, program):
        """What a program's rows are, and what is printed."""
        with contextlib.redirect_stdout(io.StringIO()) as said:
            return self.script.run({"program": program, "rows": self.rows}, "/some/hosel"), said.getvalue()

    def test_a_changed_reference_is_not_as_printed(self):
        command = {"run": "driver-toe", "from": "nothing", "rows": self.rows}
        table = {"title": "T", "text": "Text."}
        page = self.script.page([table | {"runs": [(command, [{"ours": "50.1"}])]}])[0]
        again = lambda: self.script.page([table | {"runs": [(command, self.script.kept(page, "T", command))]}])[0]
        self.assertEqual(again(), page)
        self.rows[0]["reference"] = 50.2
        self.assertNotEqual(again(), page)

    def test_the_whole_check_sees_a_changed_reference(self):
        self.file("scripts/write-validation", (SCRIPTS / "write-validation").read_text())
        self.file("docs/validation.md", (ROOT / "docs/validation.md").read_text())
        toml = (ROOT / "docs/validation.toml").read_text()
        check = [sys.executable, self.at / "scripts/write-validation", "--check", "--only", "Gear effect"]
        for change, expected in [(("", ""), 0), (("reference = 8005.59", "reference = 8005.19"), 1)]:
            # That table's command has nothing to run by: its data are missing.
            self.file("docs/validation.toml", toml.replace(*change))
            fake = self.file("hosel", '#!/bin/sh\nwhile [ "$1" != --out ]; do shift; done\nmkdir "$2"; echo \'{"skipped": 1}\' >"$2"/summary.json\n', True)
            status, said = run(*check, HOSEL=fake)
            self.assertEqual(status, expected, said)
            self.assertIn("SKIPPED: hosel run gear-effect", said)

    def test_a_program_is_given_the_command_and_its_status_counts(self):
        writes = self.file("writes", '#!/bin/sh\n[ "$2" = /some/hosel ] && echo \'{"a": {"speed": 3}}\' >"$1"\n', True)
        self.assertEqual(self.say([str(writes), "{out}", "{hosel}"])[0], [3])
        answer, said = self.say(["/bin/sh", "-c", "exit 77"])
        self.assertIsNone(answer)
        self.assertIn("SKIPPED", said)
        for words in (["/bin/sh", "-c", "exit 3"], ["/bin/sh", "-c", "kill -SEGV $$"], ["build/release/bench/bench_that_is_not_there"]):
            with self.assertRaises(SystemExit):
                self.say(words)

    def test_a_benchmark_says_itself_why_it_has_no_numbers(self):
        told = self.file("told", json.dumps({"benchmarks": [{"error_occurred": True, "error_message": "SKIPPED: no peer"}]}))
        answer, said = self.say(["/bin/cp", str(told), "{out}"])
        self.assertIsNone(answer)
        self.assertIn("SKIPPED", said)
        told.write_text(told.read_text().replace("SKIPPED: no peer", "it has not finished"))
        with self.assertRaises(SystemExit):
            self.say(["/bin/cp", str(told), "{out}"])


class Words(unittest.TestCase):
    def test_a_mistyped_word_is_no_success(self):
        for words in (["write-validation", "--chek"], ["write-validation", "--check", "--only", "Nothng"], ["write-gallery", "--chek"],
                      ["plant-errors", "--fits", "nothng"], ["check-numerics", "nothng"]):
            status, said = run(SCRIPTS / words[0], *words[1:])
            self.assertEqual(status, 2, said)


class Builds(Test):
    WRITES = '#!/bin/sh\nmkdir -p "$4"; echo "{}" >"$4"/summary.json; %s\n'

    def compare(self, old, new, *words):
        return run(SCRIPTS / "compare-builds", self.file("old", self.WRITES % old, True), self.file("new", self.WRITES % new, True), *words)

    def test_cases_inside_a_case_are_compared(self):
        nested = sum(1 for _ in ROOT.glob("cases/*/*/case.toml"))
        every = sum(1 for _ in ROOT.glob("cases/**/case.toml"))
        self.assertGreater(nested, 0)
        status, said = self.compare(":", ":")
        self.assertEqual(status, 0, said)
        self.assertIn(f"{every} of {every} cases compared", said)

    def test_what_the_new_build_writes_no_longer_is_seen(self):
        both = 'echo 1 >"$4"/more.csv'
        words = ["--keep", self.at / "kept", "rollback", "rollback/laws"]
        self.assertEqual(self.compare(both, both, *words)[0], 0)
        status, said = self.compare(both, ":", *words)
        self.assertEqual(status, 1)
        self.assertEqual(said.count("more.csv: written by one build alone"), 2, said)

    def test_an_entry_may_name_another_build_and_nothing_else(self):
        entry = 'mkdir -p "$4"/entries; printf "inputs = 1%s\\nE = %d\\n" >"$4"/entries/ball.toml'
        self.assertEqual(self.compare(entry % ("a", 1), entry % ("b", 1), "rollback")[0], 0)
        status, said = self.compare(entry % ("a", 1), entry % ("b", 2), "rollback")
        self.assertEqual(status, 1)
        self.assertIn("E = 1 | E = 2", said)

    def test_the_end_of_a_line_is_a_byte_too(self):
        for end in ("", "\\r\\n"):
            status, said = self.compare('printf "1\\n" >"$4"/a.csv', f'printf "1{end}" >"$4"/a.csv', "rollback")
            self.assertEqual(status, 1, said)

    def test_a_kept_run_keeps_its_status_and_what_it_said(self):
        words = ["--keep", self.at / "kept", "rollback"]
        for says in ("echo warning: of both >&2", "echo error: of both >&2; exit 3"):
            shutil.rmtree(self.at / "kept", ignore_errors=True)
            expected = 0 if "warning" in says else 2
            self.assertEqual(self.compare(says, says, *words)[0], expected)
            status, said = self.compare("echo run once more >&2", says, *words)
            self.assertEqual(status, expected, said)


class Deep(Test):
    def case(self, body, **more):
        """Status of a case's job where the command does this."""
        deep = module("deep-check")
        deep.WORK = self.at
        self.file("build/some/bin/hosel", "#!/bin/sh\n" + body, True)
        with contextlib.chdir(self.at), mock.patch.dict(os.environ, CASE_SECONDS="1"), open(self.at / "log", "w") as log:
            return deep.run_case("some", "driver-toe", **more).do(log, 1)

    def test_stopped_is_passed_only_by_who_computes(self):
        deadlock = "[ $1 = check ] && exit 0\nexec sleep 100\n"
        self.assertEqual(self.case(deadlock), 143)
        begin, used = time.monotonic(), os.times().children_user
        status = self.case("[ $1 = check ] && exit 0\nwhile :; do :; done\n")
        share = (os.times().children_user - used) / (time.monotonic() - begin)
        if share > 0.4:  # a machine that is full cannot tell
            self.assertEqual(status, 0)

    def test_who_does_not_stop_is_killed(self):
        deep = module("deep-check")
        words = deep.run_case("some", "driver-toe").words
        self.assertIn("-k", words)

    def test_a_check_that_crashes_is_a_failure(self):
        self.assertEqual(self.case("[ $1 = check ] && { echo told; exit 134; }\nexit 0\n"), 134)
        self.assertIn("told", (self.at / "log").read_text())
        self.assertEqual(self.case("[ $1 = check ] && exit 2\necho $@\n"), 0)
        self.assertNotIn("accuracy=look", (self.at / "log").read_text())
        self.assertEqual(self.case("[ $1 = check ] && exit 0\necho $@\n"), 0)
        self.assertIn("accuracy=look", (self.at / "log").read_text())

    def test_a_study_goes_on_from_the_points_that_another_program_left(self):
        body = """case $1 in
            sweep) for out; do :; done; mkdir -p "$out"; echo '{"version":"this one","fingerprint":"this","points":9}' > "$out/plan.json";;
            run) cat some/driver-toe/shards/1-of-1/points.jsonl;; esac
"""
        points = self.file("begun", '{"version":"another"}\nnine in ten\n')
        self.assertNotEqual(self.case(body, points=self.at / "none"), 0)
        self.assertEqual(self.case(body, points=points), 0)
        told = (self.at / "log").read_text()
        self.assertIn("this one", told)
        self.assertIn("nine in ten", told)
        self.assertNotIn("another", told)

    def test_points_that_are_left_to_compute_are_of_every_part_of_a_study(self):
        lines = ["head\n", *(f"{variant} {k}\n" for variant in ("first", "second") for k in range(60))]
        module("../tests/cases/again").hand_over(self.file("points", "".join(lines)), self.at / "begun")
        kept = (self.at / "begun").read_text().splitlines(True)
        self.assertEqual(kept, [line for line in lines if line in set(kept)])
        left = set(lines) - set(kept)
        self.assertEqual(len(left), 12)
        self.assertEqual({line.split()[0] for line in left}, {"first", "second"})

    def test_lines_are_counted_where_their_share_is_asked_for(self):
        counted = re.findall(r"^source:\*/(\w+)/\*=allow$", (ROOT / "tests/support/counted_floors").read_text(), re.M)
        self.assertEqual(counted, module("deep-check").COVERED)
        self.assertIn(f"-fprofile-list={ROOT}/tests/support/counted_floors", " ".join(module("deep-check").sanitized_options()))

    def test_what_a_job_depends_on(self):
        deep = module("deep-check")
        tree = ["docs/stability.md", "docs/validation.toml", "fem/beam.cpp", "python/module.cpp", "cmake/precompiled.hpp", "cases/a/README.md"]
        with contextlib.chdir(ROOT), mock.patch.object(deep, "committed", lambda: dict.fromkeys(tree, "1")), \
                mock.patch.object(deep, "program", lambda path: [path]):
            on = {j.name: {line.split()[0] for line in j.depends()} for j in deep.jobs_of(False) if j.depends}
        for job, read, unread in [("sanitized/others", {"docs/stability.md"}, set()), ("sanitized/app-1", {"docs/stability.md"}, set()),
                                  ("sanitized/fem", {"docs/validation.toml"}, {"docs/stability.md"}),
                                  ("properties/names", set(), {"cases/a/README.md"}),
                                  ("lint/format", {"fem/beam.cpp", "python/module.cpp", "cmake/precompiled.hpp"}, {"docs/stability.md"})]:
            self.assertLessEqual(read, on[job], job)
            self.assertFalse(unread & on[job], job)

    def test_clang_tidy_without_a_unit_is_a_failure(self):
        deep = module("deep-check")
        deep.shell = lambda log, *commands: 0
        strange = self.at / "c++ (1)"
        for name, expected in [(strange / "fem/beam.cpp", 0), (self.at / "elsewhere/fem/beam.cpp", 1)]:
            self.file("build/lint/compile_commands.json", json.dumps([{"file": str(name), "command": f"c++ -O3 {name}"}]))
            with contextlib.chdir(ROOT):
                tidy = next(j for j in deep.jobs_of(False) if j.name == "lint/tidy-1")
            with mock.patch.object(deep, "ROOT", strange), contextlib.chdir(self.at), open(self.at / "log", "w") as log:
                self.assertEqual(tidy.run.do(log, 1), expected)

    def test_sources_are_read_together_under_a_name_that_the_analyzer_knows(self):
        deep = module("deep-check")
        unity = self.file("build/lint/CMakeFiles/hosel_models.dir/Unity/unity_0_cxx.cxx", '#include "a.cpp"\n')
        names = [str(self.at / "fem/beam.cpp"), str(self.at / "fem/plate.cpp"), str(unity), str(self.at / "golf/head.cpp"), "/usr/other.cpp"]
        self.file("build/lint/compile_commands.json", json.dumps([{"file": n, "command": f"c++ {n} -o x"} for n in names]))
        with mock.patch.object(deep, "ROOT", self.at), contextlib.chdir(self.at):
            units = deep.units_together(Path("build/lint"))
        together = self.at / "build/lint/together"
        fem, models = together / "UnifiedSource-fem.cpp", together / "UnifiedSource-hosel_models-unity_0_cxx.cpp"
        self.assertEqual(set(units), {str(fem), str(models), names[3]})
        self.assertEqual(fem.read_text(), f'#include "{names[0]}"\n#include "{names[1]}"\n')
        self.assertEqual(models.read_text(), '#include "a.cpp"\n')
        told = {c["file"]: c["command"] for c in json.loads((together / "compile_commands.json").read_text())}
        self.assertEqual(told, {str(fem): f"c++ {fem} -o x", str(models): f"c++ {models} -o x", names[3]: f"c++ {names[3]} -o x"})


class References(Test):
    def test_every_file_and_every_spelling_is_read(self):
        script = self.file("scripts/check-references", (SCRIPTS / "check-references").read_text(), True)
        cited = lambda *keys: "; ".join("@" + k for k in keys).join("[]")
        self.file("docs/references.md", "".join(f"`{cited(k)}`\n" for k in ("Here_1", "there")))
        self.file("library/heads/iron.toml", cited("Here_1", "there"))
        self.file("paper/paper.bib", "@article{penner2003,\n}\n")
        self.file("paper/paper.md", cited("penner2003"))
        self.assertEqual(run(script), (0, ""))
        for place in ("library/heads/wedge.toml", "python/a.py", "paper/more.md", "quickstart", "scripts/a"):
            more = self.file(place, cited("No_Where"))
            status, said = run(script)
            self.assertEqual(status, 1, place)
            self.assertIn("@No_Where", said)
            more.unlink()
        self.file("library/heads/iron.toml", cited("there"))
        self.assertEqual(run(script)[0], 1)


class Manual(Test):
    def build(self, out, writes):
        script = self.file("scripts/build-manual", (SCRIPTS / "build-manual").read_text(), True)
        for name in ("docs/README.md", "docs/site/manual.css", "docs/picture.png", "SECURITY.md", "CONTRIBUTING.md", "CHANGELOG.md",
                     "library/README.md", "cases/one/README.md"):
            self.file(name, "")
        self.file("bin/pandoc", f'#!/bin/sh\nfor w; do case $w in --output=*) {writes} >"${{w#--output=}}" ;; esac; done\n', True)
        return run(script, out, PATH=f"{self.at}/bin:{os.environ['PATH']}")

    def test_a_folder_that_is_no_manual_is_left_alone(self):
        kept = self.file("mine/work", "hours")
        status, said = self.build(kept.parent, ":")
        self.assertEqual(status, 2, said)
        self.assertTrue(kept.exists())

    def test_pages_without_a_link_are_a_failure(self):
        for writes, expected in [(":", 1), ("echo '<a href=\"#top\">'", 0), ("echo '<a href=\"nowhere.html\">'", 1)]:
            status, said = self.build(self.at / "out", writes)
            self.assertEqual(status, expected, said)


class Slurm(Test):
    def test_the_merge_runs_where_the_array_does(self):
        self.file("bin/sbatch", f'#!/bin/sh\nfor w; do printf "%s\\n" "$w"; done >>{self.at}/said\necho >>{self.at}/said\necho "17;north"\n', True)
        status, said = run(SCRIPTS / "slurm-array", self.at, 3, "--account=club", "-p", "long days", "-Mnorth", "--time=1:00", "--mem", "4G",
                           PATH=f"{self.at}/bin:{os.environ['PATH']}", HOSEL="/bin/true")
        self.assertEqual((status, said), (0, "17 17\n"))
        array, merge = [part.splitlines() for part in (self.at / "said").read_text().split("\n\n")[:2]]
        self.assertIn("--time=1:00", array)
        self.assertIn("--dependency=afterok:17", merge)
        at = merge.index("--account=club")
        self.assertEqual(merge[at:at + 4], ["--account=club", "-p", "long days", "-Mnorth"])
        self.assertFalse({"--time=1:00", "--mem", "4G"} & set(merge))


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    unittest.main()
