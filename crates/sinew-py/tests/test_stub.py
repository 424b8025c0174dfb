"""The stub is that of the compiled module, and the package's own Python is typed."""

import subprocess
import sys
from pathlib import Path

import pytest

import sinew_sim as sn

pytest.importorskip("mypy")
FOLDER = Path(sn.__file__).parent


def mypy(*arguments, cwd):
    # Where it is not installed it is found from the folder above it.
    is_installed = FOLDER.parent.name == "site-packages"
    line = [sys.executable, "-m", *arguments]
    place = cwd if is_installed else FOLDER.parent
    return subprocess.run(line, cwd=place, capture_output=True, text=True, timeout=300)


def test_the_stub_is_that_of_the_module(tmp_path):
    said = mypy("mypy.stubtest", "sinew_sim._core", cwd=tmp_path)
    assert said.returncode == 0, said.stdout + said.stderr


def test_the_package_is_typed(tmp_path):
    said = mypy("mypy", "--strict", "--cache-dir", str(tmp_path), "-p", "sinew_sim", cwd=tmp_path)
    assert said.returncode == 0, said.stdout + said.stderr


def test_everything_public_has_words():
    for name in sn.__all__:
        value = getattr(sn, name)
        assert name == "__version__" or value.__doc__, name
        for key, own in vars(value).items() if isinstance(value, type) else ():
            if not key.startswith("_") and callable(own):
                assert own.__doc__, f"{name}.{key}"
