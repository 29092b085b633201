"""What names of a package's own Python modules are of other packages, as a table."""

import textwrap
from types import SimpleNamespace

import pytest
from rosimpact.impact.facts.python.source import extract
from rosimpact.impact.model.python.api import count_unresolved
from rosimpact.impact.model.python.own_types import OwnTypes

FILES = {
    "arm/__init__.py": "from .parts import Fitted as Part",
    "arm/base.py": """
        from lib import Node, other
        class Base(Node):
            ready: bool = False
            clock = None
            def __init__(self):
                self.clock = other.Clock()
        class Open(Node):
            def __getattr__(self, name): return name
        """,
    "arm/make.py": """
        from lib import Node
        from .base import Base
        def make(): return Node()
        def choose(x) -> "Node | None": ...
        def several(x):
            if x: return Node()
            return 3
        def each():
            yield 1
            return Node()
        async def later(): return Node()
        def build(): return Base()
        node = build()
        turned = Node()
        def turn():
            global turned
            turned = 3
        """,
    "arm/parts/__init__.py": """
        from ..base import Base as _Base, Open
        from .made import Made as Fitted
        from lib import gone as Open
        Base = _Base
        """,
    "arm/parts/made.py": "from ..base import Base\nfrom lib import Tool\nclass Made(Tool): pass\nclass Own(Base): pass",
    "arm/every.py": "from .base import *\nfrom .make import *\n",
}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("from .base import Base\nclass D(Base):\n  def _f(self): self.m()", {"lib.Node.m"}),
        ("from arm.base import Base\nclass D(Base):\n  def _f(self): super().m()", {"lib.Node.m"}),
        ("from .base import Base\nclass D(Base):\n  def _f(self): self.clock.m()", {"lib.other.Clock.m"}),
        ("from .base import Base\nclass D(Base):\n  def _f(self): self.ready", set()),
        ("from .base import Open\nclass D(Open):\n  def _f(self): self.m()", set()),
        ("from .base import *\nclass D(Base):\n  def _f(self): self.m()", {"lib.Node.m"}),
        ("from .base import *\nfrom arm.make import *\nmake().m()\nBase().m()", {"lib.Node.m"}),
        ("from unknown import *\nfrom arm.make import *\nmake().m()", {"lib.Node.m"}),
        ("from arm.make import *\nfrom unknown import *\nmake().m()", set()),
        ("from arm.make import *\ndef make(): return 3\nmake().m()", set()),
        ("from .every import *\nnode.m()", {"lib.Node.m"}),
        ("from .make import make\nmake().m()", {"lib.Node.m"}),
        ("from . import make\nmake.choose(1).m()", {"lib.Node.m"}),
        ("from .make import node\nnode.m()\nnode.clock.m()", {"lib.Node.m", "lib.other.Clock.m"}),
        # under another name, over two modules
        ("from .parts import Fitted\nFitted(1)", {"lib.Tool"}),
        ("from arm import Part\nPart().m()", {"lib.Tool", "lib.Tool.m"}),
        ("from arm import Part as P\nclass D(P):\n  def _f(self): self.m()", {"lib.Tool.m"}),
        ("from arm import Part\nclass D(Part):\n  @classmethod\n  def _f(cls): cls.m()", {"lib.Tool.m"}),
        ("from .parts import Made\nMade().m()", set()),
        ("from .parts import Open\nOpen()", set()),
        # what constructs objects
        ("from .base import Base, Open\nBase(1)\nOpen(1)", {"lib.Node"}),
        ("from .parts.made import Made\nclass D(Made):\n  def __init__(self): super().__init__(1)", {"lib.Tool"}),
        ("from .parts.made import Own\nOwn(1)", set()),
        ("from .make import make\nmake()", set()),
        ("from .make import several, each, later, turned\nseveral().m(), each().m(), later().m(), turned.m()", set()),
    ],
)
def test_what_own_names_are_of_other_packages(source, expected):
    files = {path: extract(textwrap.dedent(text).encode()) for path, text in FILES.items()}
    files["arm/user.py"] = extract(source.encode())
    types = OwnTypes(files, {"arm", "base", "make", "every", "user", "parts", "made"})
    names = [types.resolve("arm/user.py", use.name) for use in files["arm/user.py"].uses]
    assert {name for several in names for name in several if name.startswith("lib.")} == expected


def test_members_that_may_be_names_of_what_a_file_imports_are_counted():
    changing = SimpleNamespace(list_words=lambda module: frozenset({"m"}) if module == "lib" else frozenset())
    source = "import lib\ndef f(x):\n    x.m()\n    x.n()\n    lib.m()\n"
    assert count_unresolved(extract(source.encode()), changing) == 1  # type: ignore[arg-type]
    assert count_unresolved(extract(source.replace("lib", "other").encode()), changing) == 0  # type: ignore[arg-type]
