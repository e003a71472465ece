"""The arithmetic of bench.py, on costs that are made up."""

import contextlib
import io
import unittest

import bench


def cost(cpu, wall=1.0, **phases):
    return {"fields": 2000, "points": 1000, "cpuSeconds": cpu, "wallSeconds": wall,
            "peakBytes": 5e6,
            "phases": {name: {"cpuSeconds": seconds, "wallSeconds": seconds / 2} for name, seconds in phases.items()}}


class Bench(unittest.TestCase):
    def test_the_run_with_the_fewest_cpu_seconds_counts(self):
        self.assertEqual(bench.least([cost(3), cost(2), cost(4)])["cpuSeconds"], 2)

    def test_files_are_what_is_not_the_method(self):
        self.assertAlmostEqual(bench.share_around(cost(2, receive=0.1, store=0.1, vote=1.8)), 0.1)

    def test_uploads_are_no_part_of_a_job(self):
        self.assertAlmostEqual(bench.job_seconds(cost(3, receive=1, inspect=1, vote=3, store=1)), 2)

    def test_a_row_has_a_cell_for_each_column(self):
        row = bench.row_of("net", cost(2, wall=0.5, vote=2))
        self.assertEqual(row.count("|"), bench.HEADER.splitlines()[0].count("|"))
        self.assertIn("| 2.00 | 0.50 | 2000.00 | 2,000 | 5 | 0.0 % |", row)

    def test_phases_that_a_case_does_not_have_stay_empty(self):
        table = bench.phase_table({"a": cost(2, vote=2), "b": cost(4, pose=1)}).splitlines()
        self.assertEqual(table[2:], ["| vote | 100.0 % |  |", "| pose |  | 25.0 % |"])

    def test_a_comparison_has_no_ratio_of_what_takes_no_time(self):
        lines = bench.ratio_lines(cost(2, vote=2, pose=0), cost(1, vote=1, pose=0, new=1))
        self.assertTrue(lines[0].endswith("0.50"))
        self.assertTrue(any(line.split()[0] == "vote" and line.endswith("0.50") for line in lines))
        for line in lines:
            if line.split()[0] in ("pose", "new"):
                self.assertTrue(line.rstrip().endswith("s"), line)

    def test_unknown_cases_are_named(self):
        told = io.StringIO()
        with contextlib.redirect_stderr(told), self.assertRaises(SystemExit):
            bench.parsed(["cost", "bin", "--cases", "net,brick"])
        self.assertIn("no case 'brick'", told.getvalue())


if __name__ == "__main__":
    unittest.main()
