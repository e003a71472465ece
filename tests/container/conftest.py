"""What a container does beyond the black-box suite. scripts/test-container.sh runs this."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "e2e"))

from container import Container, Volume  # noqa: E402


@pytest.fixture
def volume():
    volume = Volume()
    yield volume
    volume.remove()


@pytest.fixture
def run(volume):
    """Runs containers, all on one volume."""
    containers = []

    def make(*options):
        containers.append(Container(volume, *options))
        return containers[-1]

    yield make
    for container in containers:
        container.remove()
