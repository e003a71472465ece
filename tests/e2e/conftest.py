"""The server under test: the one at LPF_URL, or the built binary on an empty folder."""

import os

import pytest

from contract import Client
from server import Server
from shapes import noisy_sphere


def needs_binary():
    if "LPF_SERVER_BINARY" not in os.environ:
        pytest.skip("needs a server of its own: set LPF_SERVER_BINARY")


@pytest.fixture(scope="session")
def client(tmp_path_factory):
    if "LPF_URL" in os.environ:
        yield Client(os.environ["LPF_URL"].rstrip("/"))
        return
    needs_binary()
    with Server(tmp_path_factory.mktemp("data")) as server:
        yield Client(server.url)


@pytest.fixture
def start(tmp_path):
    """Starts servers of the test's own, all on one folder, one after the other."""
    needs_binary()
    servers = []

    def make(*flags, log=None):
        servers.append(Server(tmp_path / "data", *flags, log=log))
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
