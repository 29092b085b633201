"""What a requirements.txt lists."""

import pytest
from rosimpact.impact.facts.requirements import extract

LINES = [
    ("numpy==1.21.5", ["numpy==1.21.5"]),
    ("numpy  # as on the robot", ["numpy"]),
    ("# numpy", []),
    ("numpy>=1.2,<2; python_version < '3.9'", ["numpy>=1.2,<2; python_version < '3.9'"]),
    ("numpy==1.2 \\", ["numpy==1.2"]),
    ("numpy==1.2 --hash=sha256:0", ["numpy==1.2"]),
    ("-r other.txt", []),
    ("--index-url https://example.org", []),
    ("./wheels/a.whl", []),
    ("numpy @ https://example.org/numpy.whl", []),
    ("git+https://example.org/a.git#egg=a", []),
]


@pytest.mark.parametrize(("line", "expected"), LINES)
def test_line(line, expected):
    found = extract(f"\n{line}\r\n".encode()).requirements
    assert [one.text for one in found] == expected
    assert all(one.line == 2 for one in found)
