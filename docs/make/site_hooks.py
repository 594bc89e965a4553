"""Hooks of MkDocs: reference and gallery, files that pages link to, equations as MathML."""

from __future__ import annotations

import posixpath
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.structure.files import File

sys.path.insert(0, str(Path(__file__).parent))

from gallery_page import gallery_page, reports
from mathml import with_mathml
from reference_pages import reference_pages

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files
    from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[2]
_LINK = re.compile(r"\[([^\]]*)\]\(([^)#:\s]+)\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages made from the table and the studies, and each file outside docs/ that a page links to."""
    for path, text in {**reference_pages(), "gallery.md": gallery_page()}.items():
        files.append(File.generated(config, path, content=text))
    for name, path in reports().items():
        files.append(File.generated(config, f"reports/{name}.html", abs_src_path=str(path)))
    wanted = {
        outside
        for file in list(files.documentation_pages())
        for _, target in _LINK.findall(file.content_string)
        if (outside := _outside(file.src_uri, target)) and _is_copied(outside)
    }
    for outside in sorted(wanted):
        files.append(File.generated(config, f"repository/{outside}", abs_src_path=str(ROOT / outside)))
    return files


def on_page_markdown(markdown: str, page: Page, **_: object) -> str:
    """Lead links out of docs/ to the copies; what is not copied (folders, other READMEs) becomes its name."""

    def replaced(match: re.Match[str]) -> str:
        text, target = match.groups()
        outside = _outside(page.file.src_uri, target)
        if not outside:
            return match.group(0)
        if not _is_copied(outside):
            return text if text.startswith("`") else f"{text} (`{outside}` in the repository)"
        here = posixpath.dirname(page.file.src_uri)
        return f"[{text}]({posixpath.relpath(f'repository/{outside}', here or '.')})"

    return _LINK.sub(replaced, markdown)


def on_page_content(html: str, **_: object) -> str:
    """Write the page's equations as MathML, which browsers show without a script."""
    return with_mathml(html)


def _outside(page: str, target: str) -> str | None:
    """Return the path of a link's target in the repository, or None if it is in docs/."""
    path = posixpath.normpath(posixpath.join("docs", posixpath.dirname(page), target))
    return None if path.startswith("docs/") else path


def _is_copied(path: str) -> bool:
    if not (ROOT / path).exists():
        raise FileNotFoundError(f"a page links to {path}, which is not in the repository")
    return (ROOT / path).is_file() and not path.endswith((".md", ".py"))
