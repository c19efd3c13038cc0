"""Tests of SciPy that differ, as `SCIPY.md` lists them, are expected to fail."""

import re
from pathlib import Path

import pytest

ROW = re.compile(r"^\| `([^`]+)` \| (.+?) \|$", re.MULTILINE)


def pattern(row):
    """Return what the first column of the table stands for: `*` for anything, `[4-8]` for one of these digits."""
    return re.compile(re.sub(r"\\\[(\d)\\-(\d)\\\]", r"[\1-\2]", re.escape(row).replace(r"\*", ".*")) + "$")


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: of SciPy's tests")
    config.addinivalue_line("markers", "fail_slow: of SciPy's tests")


def pytest_collection_modifyitems(items):
    rows = ROW.findall((Path(__file__).parent.parent / "SCIPY.md").read_text())
    different = [(pattern(row), reason) for row, reason in rows]
    for item in items:
        if item.path.name == "test_scipys_tests.py":
            name = item.nodeid.split("::", 1)[1].replace("::", ".")
            reasons = [reason for names, reason in different if names.match(name)]
            if reasons:
                item.add_marker(pytest.mark.xfail(reason=reasons[0], strict=True))
