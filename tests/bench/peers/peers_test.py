"""The comparison with the peers judges and tells runs as it says; no peer is needed for that."""

import sys
import tempfile
import unittest
from pathlib import Path

import measured
import methods
import shapes
import table


def run_python(code, cpu_limit=60):
    with tempfile.TemporaryDirectory() as folder:
        return measured.run([sys.executable, "-c", code], cpu_limit, Path(folder) / "log")


def scan_of(shape, noise=0.05, spacing=0.01):
    return shapes.Scan(shape, Path("scan.ply"), noise, spacing, ("--shape", shape.source))


def run_with(rmse, outcome="ok"):
    error = {"rmse": rmse, "parts": {"surface": {"rmse": rmse}}, "coverage": {"surface": 0.5}}
    return {"shape": "cube", "outcome": outcome, "settings": {"radius": rmse}, "cpuSeconds": 1.0,
            "memoryBytes": 2_000_000, **({"error": error} if outcome == "ok" else {})}


class Measured(unittest.TestCase):
    def test_counts_cpu_and_memory_of_children_too(self):
        used = run_python("import subprocess, sys; subprocess.run([sys.executable, '-c', "
                          "'x = bytearray(200_000_000); sum(range(3_000_000))'])")
        self.assertEqual(used.outcome, "ok")
        self.assertGreater(used.memory_bytes, 200_000_000)
        self.assertGreater(used.cpu_seconds, 0.01)

    def test_tells_what_became_of_a_program(self):
        self.assertEqual(run_python("import sys; sys.exit(3)").outcome, "failed: exit code 3")
        self.assertEqual(run_python("import os; os.abort()").outcome, "crashed: SIGABRT")
        self.assertEqual(run_python("while True: pass", cpu_limit=1).outcome,
                         "stopped after 1 CPU s")


class Settings(unittest.TestCase):
    def test_are_few_and_differ_for_every_peer_and_none_for_ours(self):
        for shape in shapes.SHAPES:
            for method in methods.METHODS:
                if method.resamples and not shape.resample:
                    continue
                tried = method.settings(scan_of(shape))
                self.assertEqual(len({str(settings) for settings in tried}), len(tried))
                self.assertLessEqual(len(tried), 4, method.name)
                if method.name == "ours":
                    self.assertEqual(tried, [{}])

    def test_radius_holds_points_where_the_noise_is_less_than_the_spacing(self):
        quiet = scan_of(shapes.SHAPES[0], noise=1e-6)
        self.assertEqual(quiet.neighbours(3), 20)
        self.assertAlmostEqual(scan_of(shapes.SHAPES[0], noise=1.0).radius(3), 3.0, places=3)


class Table(unittest.TestCase):
    def test_best_has_the_least_error_of_those_that_ended_well(self):
        runs = [run_with(3.0), run_with(2.0), run_with(0.0, "crashed: SIGABRT")]
        self.assertEqual(table.best_of(runs)["settings"], {"radius": 2.0})
        self.assertEqual(table.best_of(runs[2:])["outcome"], "crashed: SIGABRT")

    def test_every_row_has_as_many_cells_as_the_head(self):
        facts = {"noise": 0.1, "points": 5, "error": {"diagonal": 2.0, **run_with(9.0)["error"]}}
        failed = run_with(0.0, "stopped after 900 CPU s")
        runs = [("A", [run_with(1.0)]), ("B", [failed])]
        lines = table.shape_section(shapes.SHAPES[0], facts, runs, [])
        rows = [line for line in lines if line.startswith("|")]
        self.assertEqual(len({row.count("|") for row in rows}), 1, rows)
        self.assertIn("stopped after 900 CPU s", rows[-1])


if __name__ == "__main__":
    unittest.main()
