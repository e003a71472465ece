"""The methods and the few settings that each is tried with. Ours has none."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import meshlab
import measured
import service


@dataclass(frozen=True)
class Programs:
    """Where things are."""
    server: Path
    peers: Path      # folder of cgal-peer and pcl-peer
    cpu_limit: int   # seconds, of each run of a peer


@dataclass(frozen=True)
class Method:
    name: str
    label: str
    resamples: bool
    settings: Callable   # scan -> list of {name: number}
    run: Callable        # (programs, scan, settings, result, log) -> Usage


def _command(program, method):
    def run(programs, scan, settings, result, log):
        arguments = [f"{name}={value}" for name, value in settings.items()]
        return measured.run([str(programs.peers / program), method, str(scan.path), str(result),
                             *arguments], programs.cpu_limit, log)
    return run


def _meshlab(name):
    def run(programs, scan, settings, result, log):
        script = Path(log).with_suffix(".mlx")
        meshlab.write_script(script, name, settings)
        usage = measured.run(["meshlabserver", "-i", str(scan.path), "-o", str(result),
                              "-s", str(script)], programs.cpu_limit, log)
        if usage.outcome == "ok" and not Path(result).exists():
            usage.outcome = "failed: no result"
        return usage
    return run


def _ours(process):
    def run(programs, scan, settings, result, log):
        query = "?" + "&".join(f"{name}={value}" for name, value in settings.items())
        return service.run(str(programs.server), process, query.rstrip("?"), scan.path, result, log)
    return run


# Balls and disks are given in standard deviations of the noise, see Scan.radius. The first setting
# of each is the one that is most often the best.

def _bilateral(scan):
    def neighbours(noises, iterations):
        most = 450_000_000 // scan.shape.points // iterations  # or a run takes beyond its limit
        return min(scan.neighbours(noises), most)
    return [{"neighbours": neighbours(noises, iterations), "angle": angle, "iterations": iterations}
            for noises, angle, iterations in [(3, 25, 3), (3, 25, 1), (6, 12, 1), (2, 25, 2)]]


def _jet(scan):
    return [{"neighbours": scan.neighbours(noises), "iterations": 1}
            for noises in (3, 2, 4.5, 6)]


def _wlop(scan):
    return [{"percent": percent, "radius": scan.radius(4), "iterations": 35}
            for percent in (20, 50)]


def _mls(scan):
    return [{"radius": scan.radius(noises), "order": 2} for noises in (3, 4.5, 2, 6)]


def _projection(**own):
    """MeshLab's scale is in local spacings."""
    def settings(scan):
        return [{"neighbours": scan.neighbours(2), "scale": scan.scale(noises), **own}
                for noises in (4, 2.5)]
    return settings


def _ear(scan):
    return [{"neighbours": scan.neighbours(noises), "angle": angle, "iterations": iterations,
             "sensitivity": 0, "radius": round(3 * scan.spacing, 4),
             "points": scan.shape.resample}
            for noises, angle, iterations in [(3, 25, 1), (3, 25, 2), (4.5, 25, 2), (6, 12, 1)]]


def _upsampling(more):
    """MLS at a few radii; `more` gives the rest of the settings for one of them."""
    def settings(scan):
        return [{"radius": scan.radius(noises), "order": 2, **more(scan, noises)}
                for noises in (3, 4.5, 6)]
    return settings


def _plane(scan, _):  # four points of the lattice are within reach
    return {"reach": round(0.5 * scan.spacing, 4), "step": round(0.5 * scan.spacing / 1.2, 4)}


def _random(scan, noises):  # PCL adds at most density / 2 / neighbours points to each
    return {"density": round(2.4 * scan.growth * scan.neighbours(noises))}


def _voxels(scan, _):  # about three layers of voxels end on the surface
    return {"voxel": round(1.7 * scan.target_spacing, 4), "dilations": 1}


METHODS = [
    Method("ours", "LPF Server", False, lambda scan: [{}], _ours("denoise")),
    Method("cgal_bilateral", "CGAL bilateral", False, _bilateral,
           _command("cgal-peer", "bilateral")),
    Method("cgal_jet", "CGAL jet", False, _jet, _command("cgal-peer", "jet")),
    Method("cgal_wlop", "CGAL WLOP", False, _wlop, _command("cgal-peer", "wlop")),
    Method("pcl_mls", "PCL MLS", False, _mls, _command("pcl-peer", "mls")),
    Method("meshlab_apss", "MeshLab APSS", False, _projection(sphericity=1), _meshlab("APSS")),
    Method("meshlab_rimls", "MeshLab RIMLS", False, _projection(sharpness=0.75),
           _meshlab("RIMLS")),
    Method("ours_resample", "LPF Server", True,
           lambda scan: [{"targetPoints": scan.shape.resample}], _ours("resample")),
    Method("cgal_ear", "CGAL bilateral, then EAR", True, _ear, _command("cgal-peer", "ear")),
    Method("pcl_plane", "PCL MLS, local planes", True, _upsampling(_plane),
           _command("pcl-peer", "plane")),
    Method("pcl_random", "PCL MLS, random density", True, _upsampling(_random),
           _command("pcl-peer", "random")),
    Method("pcl_voxels", "PCL MLS, dilated voxels", True, _upsampling(_voxels),
           _command("pcl-peer", "voxels")),
]
