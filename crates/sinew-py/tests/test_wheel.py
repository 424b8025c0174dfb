"""The wheel: which Pythons take it."""

import pytest

tags = pytest.importorskip("packaging.tags")
PLATFORM = "manylinux_2_35_x86_64"
WHEEL = f"cp310-abi3-{PLATFORM}"


def taken(version, abi):
    """The tags of wheels that a Python takes."""
    return {str(tag) for tag in tags.cpython_tags(version, abis=[abi], platforms=[PLATFORM])}


@pytest.mark.parametrize("minor", [10, 11, 12, 13, 14])
def test_every_python_from_3_10_on_takes_the_one_wheel(minor):
    assert WHEEL in taken((3, minor), f"cp3{minor}")


def test_python_3_9_does_not():
    assert WHEEL not in taken((3, 9), "cp39")


@pytest.mark.parametrize("minor", [13, 14])
def test_python_without_the_gil_does_not(minor):
    """Its objects have another layout: pip finds no wheel in place of one that would break."""
    assert WHEEL not in taken((3, minor), f"cp3{minor}t")
