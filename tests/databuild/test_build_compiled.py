"""Which names of libraries need a link: by what `nm` prints of them, and by sources."""

import subprocess
from pathlib import Path

import pytest
from rosimpact.databuild.compiled import Symbols, build_table, read_sources, read_symbols
from rosimpact.databuild.extract import cpp
from rosimpact.impact.targets.providers.compiled import CompiledNames, CompiledTable, load_compiled

HEADER = b"""
extern "C" int winch_open(const char * name);
namespace winch {
int pull(double force);
inline int rest() { return 0; }
template <typename T> T twice(T value);
int moved(int one);
int moved(double other);
class Rope {
public:
  Rope(int length);
  ~Rope();
  static Rope load(int place);
  int cut();
};
class Knot {
public:
  Knot() {}
  explicit Knot(int turns);
};
class Hook {
public:
  Hook() {}
  virtual void grab();
};
struct Plain { int field; };
}
"""
PRINTED = """\
0000000000001000 T winch_open@@WINCH_1.0
0000000000001010 T winch::pull(double)
0000000000001020 W winch::rest()
0000000000001030 T winch::moved(int)
0000000000001040 T winch::Rope::Rope(int)
0000000000001050 T winch::Rope::~Rope()
0000000000001060 T winch::Rope::load[abi:cxx11](int)
0000000000001065 T winch::Rope::cut()
0000000000001070 T winch::Knot::Knot(int)
0000000000002000 D vtable for winch::Hook
0000000000002010 V vtable for winch::Plain
"""


def list_declared():
    return cpp.extract(HEADER).entities


def test_strong_symbols_that_a_header_declares_need_a_link():
    symbols = Symbols()
    symbols.add("winch", PRINTED)
    # Of `moved` one form is elsewhere; a Knot can be made by what is inline; `cut` is called on an object.
    assert symbols.select(list_declared()) == dict.fromkeys(
        ("winch_open", "winch::pull", "winch::Rope{}", "winch::Rope::load", "winch::Hook{}"), "winch"
    )


def test_short_names_of_c_are_words_of_anything():
    symbols = Symbols()
    symbols.add("winch", "0 T reel\n")
    assert symbols.select(cpp.extract(b"int reel(int length);").entities) == {}


DECLARED_BY_MACROS = b"""
#define WINCH_API(type) extern type
WINCH_API(int) winch_reel(int length);
WINCH_EXTERN int WINCH_CALL winch_brake WINCH_ARGS((int force));
#define winch_shown(one) winch_reel(one)
static inline int winch_rest(void) { return 0; }
"""


def test_functions_of_c_that_macros_declare_need_a_link_too():
    symbols = Symbols()
    read_symbols([("usr/include/winch.h", DECLARED_BY_MACROS), ("usr/share/doc/winch.h", b"winch_hidden(")], symbols)
    symbols.add("winch", "".join(f"0 T winch_{one}\n" for one in ("reel", "brake", "shown", "hidden")))
    symbols.add("winch", "0 T winch_other(int)\n0 W winch_rest\n")
    # A macro is no function, and a library has functions that no header names.
    assert set(symbols.select(())) == {"winch_reel", "winch_brake"}


def test_libraries_that_differ_in_the_version_in_their_names_are_all_read(monkeypatch):
    read = []

    def run(command, **options):
        read.append(Path(command[-1]).read_bytes())
        return subprocess.CompletedProcess(command, 0, f"0 T winch_of_{read[-1].decode()}\n", "")

    monkeypatch.setattr(subprocess, "run", run)
    symbols = Symbols()
    where = "usr/lib/x86_64-linux-gnu"
    files = {
        "libwinch-0.1.so.4.4": b"old",
        "libwinch-0.1.so.4": b"old",
        "libwinch-1.0.so.0": b"new",
        "libwinch.a": b"a",
    }
    read_symbols([(f"{where}/{name}", data) for name, data in files.items()], symbols)
    # A link is not read twice, and a static library not beside a shared one.
    assert read == [b"old", b"new"]
    assert symbols.stems == {"winch_of_old": "winch", "winch_of_new": "winch"}


def test_sources_tell_the_same_without_namespaces():
    source = b"""
namespace winch {
// int pulled() {
int pull(double force)
{
  return 0;
}
Rope::Rope(int length) : length_(length)
{
}
Rope::~Rope()
{
}
template <typename T>
T twice(T value)
{
  return value;
}
}
"""
    symbols = read_sources(["rope.cpp", "made.cpp"], lambda path: source if path == "rope.cpp" else _raise(path))
    assert set(symbols.select(list_declared())) == {"winch::pull", "winch::Rope{}"}


def _raise(path: str):
    raise FileNotFoundError(path)


def test_what_is_no_library_has_no_symbols():
    symbols = Symbols()
    read_symbols([("usr/lib/x86_64-linux-gnu/libwinch.so.1", b"text"), ("usr/share/doc/winch", b"text")], symbols)
    assert not symbols.overloads and not symbols.tables


def test_a_name_of_two_owners_tells_of_neither():
    table = build_table(
        {"winch": {"winch": "winch_open winch::pull winch::Rope{}"}, "crane": {"crane": "winch_open"}},
        {("rope", 1): ["rope::tie"], ("rope", 2): ["rope::tie"], ("cord", 2): ["rope::untie"]},
    )
    names = CompiledNames(table)
    assert "winch_open" not in names.functions and not names.words
    assert names.find("winch::Rope").stem == "winch" and "winch::Rope" in names.classes
    assert names.find("rope::tie").ros == (1, 2) and names.find("rope::untie").ros == (2,)
    with pytest.raises(KeyError):
        names.find("winch::Knot")
    assert not CompiledNames(CompiledTable()).functions


@pytest.mark.parametrize(
    ("name", "owner", "ros"),
    [
        ("YAML::LoadFile", "yaml-cpp", ()),
        ("tinyxml2::XMLDocument", "tinyxml2", ()),
        ("curl_easy_init", "curl", ()),
        ("libusb_init", "libusb", ()),
        ("usb_find_devices", "libusb", ()),
        ("yaml_parser_load", "libyaml", ()),
        ("ros::init", "roscpp", (1,)),
        ("rclcpp::init", "rclcpp", (2,)),
        ("cv_bridge::toCvCopy", "cv_bridge", (1, 2)),
    ],
)
def test_names_of_the_shipped_table(name, owner, ros):
    found = load_compiled().find(name)
    assert (found.owner, found.ros) == (owner, ros)


@pytest.mark.parametrize("name", ["YAML::Node", "Eigen::Matrix3d", "nlohmann::json", "pluginlib::ClassLoader"])
def test_what_is_inline_or_a_template_is_not_in_the_shipped_table(name):
    known = load_compiled()
    assert name not in known.functions and name not in known.classes
