# SPDX-License-Identifier: BSD-3-Clause
"""What was built: the library, and the package that loads it. Tests that import this are skipped where there is none."""

import os
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("TACTUS_BUILD", ROOT / "build" / "release"))
LIBRARY = BUILD / "lib" / "libtactus.so"
SHELF = ROOT / "tests" / "capi" / "small_shelf.yaml"

if not LIBRARY.exists():
    pytest.skip(f"{LIBRARY} is not built", allow_module_level=True)
os.environ.setdefault("TACTUS_LIBRARY", str(LIBRARY))
sys.path.insert(0, str(ROOT / "python_shim"))
import tactus  # noqa: E402, F401
