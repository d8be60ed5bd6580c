"""The site builds without a warning, reads no one else's script, and shows its equations."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from blocks import PAGES, ROOT

pytest.importorskip("sphinx", reason="needs the extra docs")
pytest.importorskip("furo", reason="needs the extra docs")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built pages."""
    out = tmp_path_factory.mktemp("site")
    done = build(ROOT / "docs", out)
    assert done.returncode == 0, done.stderr[-3000:]
    return out


def build(source: Path, out: Path) -> subprocess.CompletedProcess[str]:
    """What `make docs` does."""
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"]
    return subprocess.run([*command, str(source), str(out)], capture_output=True, text=True)


@pytest.mark.slow
def test_every_page_is_there(site: Path) -> None:
    pages = [page for page in PAGES if page.parent.name == "docs"]
    assert len(pages) > 20
    assert [page.stem for page in pages if not (site / f"{page.stem}.html").is_file()] == []


@pytest.mark.slow
def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    loaded = re.compile(
        r'<(?:script|img|iframe|source)[^>]+src="(?:https?:)?//|<link[^>]+href="(?:https?:)?//|@import'
    )
    for page in site.glob("*.html"):
        assert not loaded.search(page.read_text(encoding="utf-8")), page.name


@pytest.mark.slow
def test_equations_are_mathml(site: Path) -> None:
    page = (site / "theory.html").read_text(encoding="utf-8")
    assert page.count("<math") > 60
    assert page.count('display="block"') > 12
    assert re.search(r'<msub><mover accent="true"><mi>J</mi><mo[^>]*>ˉ</mo></mover><mi>p</mi></msub>', page)
    text = re.sub(r"<(math|code|script|style|pre)\b.*?</\1>", "", page, flags=re.DOTALL)
    assert "$" not in text
    assert "\\frac" not in text


@pytest.mark.slow
def test_a_bad_equation_and_a_bad_link_fail_the_build(tmp_path: Path) -> None:
    source = tmp_path / "docs"
    source.mkdir()
    for name in ("conf.py", "_ext", "_static"):
        place = ROOT / "docs" / name
        (shutil.copytree if place.is_dir() else shutil.copyfile)(place, source / name)
    (source / "index.md").write_text("# Site\n\n$$x = 1$$\n")
    assert build(source, tmp_path / "good").returncode == 0
    (source / "index.md").write_text("# Site\n\n$$\\nosuchcommand$$\n")
    assert "equation cannot be read" in build(source, tmp_path / "equation").stderr
    (source / "index.md").write_text("# Site\n\n[page](absent.md)\n")
    assert build(source, tmp_path / "link").returncode != 0
