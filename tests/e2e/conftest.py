"""The server under test: the one at LPF_URL, or one that is started here on an empty folder.

Tests that need a server of their own start the program that program.py names; without one, and with
LPF_URL alone, they are skipped.
"""

import os

import pytest

import program
from contract import Client
from server import Server
from shapes import noisy_sphere


def needs_program():
    if not program.is_there():
        pytest.skip("needs a server of its own: set LPF_SERVER_BINARY or LPF_IMAGE")


@pytest.fixture(scope="session")
def client(tmp_path_factory):
    if "LPF_URL" in os.environ:
        yield Client(os.environ["LPF_URL"].rstrip("/"))
        return
    needs_program()
    with Server(tmp_path_factory.mktemp("data")) as server:
        yield Client(server.url)


@pytest.fixture
def start(tmp_path):
    """Starts servers of the test's own, all on one folder, one after the other."""
    needs_program()
    servers = []

    def make(*flags, **options):
        servers.append(Server(tmp_path / "data", *flags, **options))
        return servers[-1]

    yield make
    for server in servers:
        server.__exit__()


@pytest.fixture(scope="session")
def sphere():
    return noisy_sphere()


@pytest.fixture(scope="session")
def done(client, sphere):
    """Path of a successful denoising."""
    return client.run("denoise", sphere)
