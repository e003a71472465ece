"""The scans that all methods get: shapes of lpf-scan, with the truth known."""

import hashlib
import json
import math
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Shape:
    name: str
    source: str          # a shape of lpf-scan, or "mesh": the file that was given
    points: int
    noise: str           # standard deviation in each coordinate; "1%" is of the diagonal
    resample: int = 0    # also resampled to so many points


SHAPES = [
    Shape("curvenet_124", "curvenet", 400_000, "0.124"),
    Shape("curvenet_25", "curvenet", 400_000, "0.25"),
    Shape("curvenet_38", "curvenet", 400_000, "0.38"),
    Shape("cube", "cube", 150_000, "0.05"),
    Shape("cube_with_curve", "cube_with_curve", 80_000, "0.01", resample=360_000),
    Shape("fandisk_1", "mesh", 600_000, "1%"),
    Shape("fandisk_15", "mesh", 600_000, "1.5%"),
    Shape("fandisk_2", "mesh", 600_000, "2%"),
    Shape("thin_plate", "thin_plate", 80_000, "0.008"),
    Shape("fin", "fin", 80_000, "0.01"),
]


@dataclass(frozen=True)
class Scan:
    """A simulated scan, and what the settings of the peers are derived from."""
    shape: Shape
    path: Path
    noise: float      # standard deviation in each coordinate, units of the file
    spacing: float    # side of the square that each point on a surface has for itself
    reference: tuple  # arguments that tell lpf-scan the truth

    def radius(self, noises):
        """Of a ball, in standard deviations of the noise; of 3 it holds 20 points at least."""
        return round(noises * math.hypot(self.noise, 2.5 / 3 * self.spacing), 4)

    def scale(self, noises):
        """That radius in spacings."""
        return round(self.radius(noises) / self.spacing, 1)

    def neighbours(self, noises):
        """How many points a disk of that radius holds."""
        return round(math.pi * (self.radius(noises) / self.spacing) ** 2)

    @property
    def growth(self):
        """How many points are wanted for each that there is."""
        return self.shape.resample / self.shape.points

    @property
    def target_spacing(self):
        """Like `spacing`, of what the scan is to be resampled to."""
        return self.spacing / math.sqrt(self.growth)


def simulate(tool, shape, mesh, seed, folder):
    """Writes the scan of a shape, if it is not there yet."""
    name, truth = f"{shape.name}-{seed}", ("--shape", shape.source)
    if shape.source == "mesh":
        name += "-" + hashlib.sha256(Path(mesh).read_bytes()).hexdigest()[:8]
        truth = ("--mesh", mesh)
    path = folder / f"{name}.ply"
    told = path.with_suffix(".json")
    if not (path.exists() and told.exists()):
        percent = shape.noise.endswith("%")
        command = [tool, "simulate", *truth, "--points", str(shape.points), "--seed", str(seed),
                   "--noise-percent" if percent else "--noise", shape.noise.rstrip("%"),
                   "-o", str(path)]
        told.write_bytes(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    facts = json.loads(told.read_text(encoding="utf-8"))
    on_surfaces = facts["points"] - facts["pointsOnCurves"]
    reference = ("--reference", mesh) if shape.source == "mesh" else truth
    return Scan(shape, path, facts["noise"], math.sqrt(facts["area"] / on_surfaces), reference)


def measure(tool, scan, result):
    """What lpf-scan says of a result: error by part, coverage, spacing."""
    command = [tool, "error", str(result), *scan.reference, "--detailed",
               "--edge-distance", str(scan.radius(3))]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
