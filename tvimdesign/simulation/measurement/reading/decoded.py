"""Bytes of a text file as text, whatever it was written in: UTF-8, UTF-16 with or without its mark, Windows' Latin."""

from __future__ import annotations

import codecs
from pathlib import Path

from tvimdesign.base.errors import InputError

LARGEST_FILE = 64_000_000
_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_LOOKED_AT = 4000


def file_bytes(path: Path) -> bytes:
    """Content of a file of measured data. Raises InputError where there is none, or more than `LARGEST_FILE` bytes."""
    try:
        if not path.is_file():
            raise InputError(f"{path}: there is no such file")
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise InputError(f"{path}: {size / 1e6:.0f} MB; files of data are read up to {LARGEST_FILE / 1e6:.0f} MB")
        return path.read_bytes()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({type(error).__name__})") from None


def decoded(data: bytes, file: str) -> tuple[str, str]:
    """The text, and the encoding it was in. Raises InputError where it is no text."""
    encoding = _encoding(data)
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError:
        encoding = "cp1252"
        text = data.decode(encoding, errors="replace")
    if "\0" in text:
        raise InputError(f"{file}: this is no text; export the data as text, CSV or Excel (.xlsx)")
    return text, encoding


def _encoding(data: bytes) -> str:
    for mark, name in _MARKS:
        if data.startswith(mark):
            return name
    begin = data[:_LOOKED_AT]
    # Western text in UTF-16 has a zero in every second byte.
    even, odd = begin[0::2].count(0), begin[1::2].count(0)
    if odd > 0.4 * len(begin) / 2 and even == 0:
        return "utf-16-le"
    if even > 0.4 * len(begin) / 2 and odd == 0:
        return "utf-16-be"
    return "utf-8"
