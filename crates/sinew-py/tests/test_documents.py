"""The README of the package and the chapter on Python: every block runs, and gives the output that is shown behind it.

A heading of level 2 begins a new namespace. A block of Python may begin with `# needs: package ..`, and is skipped if one is
absent. A block of TOML that begins with `# name.toml` is written to the folder in which the document runs. A block of text right
behind one of Python is its output: words are compared exactly, numbers to three digits. `text measured` shows times of one computer: its lines are counted only.
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[3]
DOCUMENTS = [ROOT / "crates" / "sinew-py" / "README.md", ROOT / "docs" / "python.md"]


class Block(NamedTuple):
    line: int
    language: str
    text: str


class Section(NamedTuple):
    document: Path
    title: str
    blocks: list[Block]


def sections(document: Path) -> list[Section]:
    found, begun = [Section(document, "top", [])], None
    lines = document.read_text(encoding="utf-8").split("\n")
    for number, line in enumerate(lines, 1):
        if begun is not None:
            if line == "```":
                found[-1].blocks.append(Block(begun[0], begun[1], "\n".join(lines[begun[0] : number - 1]) + "\n"))
                begun = None
        elif line.startswith("```"):
            begun = number, line.removeprefix("```")
        elif line.startswith("## "):
            found.append(Section(document, line.removeprefix("## "), []))
        elif line.strip() and found[-1].blocks and found[-1].blocks[-1].language != "":
            found[-1].blocks.append(Block(number, "", ""))  # prose: an output must be right behind its block
    assert begun is None, f"{document}:{begun}: a block without an end"
    return [section for section in found if any(block.language == "python" for block in section.blocks)]


SECTIONS = [section for document in DOCUMENTS for section in sections(document)]
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?\binf\b")


def difference(shown: str, got: str, is_measured: bool) -> str | None:
    """What differs between an output that is shown and the one that came."""
    shown_lines, got_lines = shown.strip().split("\n"), got.strip().split("\n")
    if len(shown_lines) != len(got_lines):
        return f"{len(shown_lines)} lines are shown, {len(got_lines)} came"
    for own, came in zip(shown_lines, got_lines if not is_measured else []):
        words, came_words = (" ".join(NUMBER.sub("#", line).split()) for line in (own, came))
        if words.replace("[ ", "[") != came_words.replace("[ ", "["):
            return f"shown: {own}\ncame:  {came}"
        numbers, came_numbers = ([float(number) for number in NUMBER.findall(line)] for line in (own, came))
        # What is nothing beside the other numbers of a line is rounding.
        rounding = 1e-6 * max((abs(number) for number in numbers), default=0.0)
        for number, other in zip(numbers, came_numbers):
            if number != other and abs(number - other) > max(5e-3 * abs(number), rounding):
                return f"shown: {own}\ncame:  {came}"
    return None


def run(block: Block, document: Path, names: dict[str, Any]) -> str:
    """What a block prints."""
    code = "\n" * block.line + block.text
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(code, str(document), "exec"), names)
    return out.getvalue()


def needs(block: Block) -> list[str]:
    """Packages that a block needs and that are absent."""
    first = block.text.split("\n", 1)[0]
    packages = first.removeprefix("# needs:").split() if first.startswith("# needs:") else []
    return [package for package in packages if importlib.util.find_spec(package) is None]


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, Path]:
    found = {}
    for document in DOCUMENTS:
        found[document] = tmp_path_factory.mktemp("document")
        for block in re.findall(r"^```toml\n(# (\S+\.toml)\b.*?)^```$", document.read_text("utf-8"), re.M | re.S):
            (found[document] / block[1]).write_text(block[0], encoding="utf-8")
    return found


@pytest.mark.parametrize("section", SECTIONS, ids=[f"{s.document.parent.name}/{s.document.name}: {s.title}" for s in SECTIONS])
def test_blocks_run_and_print_what_is_shown(
    section: Section, folders: dict[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folders[section.document])
    names: dict[str, Any] = {"__name__": "__main__"}
    absent: list[str] = []
    for number, block in enumerate(section.blocks):
        if block.language != "python":
            continue
        if missing := needs(block):
            absent += missing
            continue
        got = run(block, section.document, names)
        behind = section.blocks[number + 1] if number + 1 < len(section.blocks) else None
        if behind is None or not behind.language.startswith("text"):
            assert got == "", f"{section.document}:{block.line}: prints what is not shown:\n{got}"
            continue
        found = difference(behind.text, got, behind.language == "text measured")
        assert found is None, f"{section.document}:{behind.line}: {found}\nall that came:\n{got}"
    if absent:
        pytest.skip(f"blocks were not run without {', '.join(sorted(set(absent)))}")


def test_the_documents_have_blocks() -> None:
    assert {section.document for section in SECTIONS} == set(DOCUMENTS)


def test_the_readme_fits_the_page_of_a_package() -> None:
    assert DOCUMENTS[0].stat().st_size <= 8192


def test_a_wrong_output_is_found() -> None:
    assert difference("force 1.29", "force 1.2901", False) is None
    assert difference("[-3.1e-15  1.296]", "[ 2.0e-16 1.296]", False) is None
    assert difference("force 1.29", "force 1.31", False) is not None
    assert difference("force 1.29", "torque 1.29", False) is not None
    assert difference("force 1.29", "force 1.29\nmore", False) is not None
    assert difference("newmark in 1.29 s", "cnn in 7 s", True) is None
    assert difference("newmark in 1.29 s", "cnn\nin 7 s", True) is not None
