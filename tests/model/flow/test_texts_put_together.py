"""What strings are that code puts together, formats, or changes in place."""

import pytest
from joining import graph

CPP = """
class Buoy : public rclcpp::Node {
 public:
  Buoy() : Node("buoy") {
    HERE
  }
  std::string kept_ = "kept";
};
int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Buoy>()); }
"""
PYTHON = """
import os

import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Names:
    HORN = "/horn"


class Buoy(Node):
    def __init__(self):
        super().__init__("buoy")
        count = 2
        side = "port"
        HERE

    @property
    def prefix(self):
        return "/north"


def main():
    rclpy.spin(Buoy())
"""
IN_CPP = [
    ('std::string n = "/a"; n += \'b\';', "n", "/ab"),
    ("", "std::string(\"/a\") + '/' + \"b\"", "/a/b"),
    ("", 'fmt::format("/{}/depth", "left")', "/left/depth"),
    ("", 'std::format("/{1}/{0}", "depth", "left")', "/left/depth"),
    ("", 'fmt::format("/leg{:02d}", 3)', "/leg03"),
    ('std::ostringstream out; out << "/cam" << 3 << "/image";', "out.str()", "/cam3/image"),
    ('std::stringstream out; out << "/old"; out.str("/new"); out << "/x";', "out.str()", "/new/x"),
    ('char name[50]; snprintf(name, sizeof(name), "/imu%d/data", 2);', "name", "/imu2/data"),
    ('char name[50]; sprintf(name, "/imu%02d", 2);', "name", "/imu02"),
    ('std::filesystem::path base("/maps");', 'base / "city"', "/maps/city"),
    ('std::filesystem::path base("/maps/");', 'base / "city"', "/maps/city"),
    ("", 'boost::format("/leg%1%") % 3', "/leg3"),
    # What is read of a string, or is made of it, leaves it as it is.
    ('std::string n = "/a"; if (std::find(n.begin(), n.end(), \'a\') != n.end()) {}', "n", "/a"),
    ('std::string n = "/a"; auto other = boost::to_upper_copy(n);', "n", "/a"),
    ('std::string n = "/a"; std::vector<int> v; v.push_back(1); v.insert(v.begin(), 2);', "n", "/a"),
    # What is changed in place is not what it was.
    ('std::string n = "/a"; n.insert(1, "b");', "n", "?"),
    ('std::string n = "/a"; n.replace(1, 1, "b");', "n", "?"),
    ('std::string n = "/a"; n.push_back(next());', "n", "?"),
    ('std::string n = "/a"; n[1] = \'b\';', "n", "?"),
    ('std::string n = "/a"; std::replace(n.begin(), n.end(), \'a\', \'b\');', "n", "?"),
    ('std::string n = "/a"; boost::replace_all(n, "a", "b");', "n", "?"),
    ("char host[64]; host[63] = '\\0'; gethostname(host, 63);", '"/" + std::string(host)', "?"),
    ("char name[3]; name[0] = 'q';", "std::string(name)", "?"),
    ("", "std::string(\"/a\") + '\\0'", "?"),
    ("", "std::string(\"/a\") + 'b'", "/ab"),
    ('kept_.replace(0, 1, "x");', '"/" + kept_', "?"),
    ("", "std::string(3, 'x')", "?"),
    ('char name[50]; snprintf(name, sizeof(name), "/imu%s", find());', "name", "?"),
    ('std::ostringstream out; out << "/cam" << find();', "out.str()", "?"),
    # Written again, it is what is written.
    ('std::string n = "/a"; n.insert(1, "b"); n = "/c";', "n", "/c"),
]  # fmt: skip
IN_PYTHON = [
    ('"/a{:02d}".format(2)', "/a02"),
    ('"/a{}".format(2)', "/a2"),
    ('"/a%02d" % 2', "/a02"),
    ('"/a%d/%s" % (2, side)', "/a2/port"),
    ('f"/a{count:03}"', "/a002"),
    ('f"/{side:s}"', "/port"),
    ('"/a" + str(count + 1)', "/a3"),
    ('"/" + "/".join([side, "scan"])', "/port/scan"),
    ('os.path.join("/map", side)', "/map/port"),
    ('Path("/map") / "city"', "/map/city"),
    ('"/PORT".lower()', "/port"),
    ('"/" + side.upper()', "/PORT"),
    ('"/a_x".replace("_x", "_y")', "/a_y"),
    ('"/a/".rstrip("/")', "/a"),
    ('Names.HORN', "/horn"),
    ('self.prefix + "/scan"', "/north/scan"),
    # How it is written is not followed.
    ('f"/a{side!r}"', "?"),
    ('f"/a{side:>9}"', "?"),
    ('"/a{:x}".format(count)', "?"),
    ('"/a" + side.title()', "?"),
    ('"/".join(find())', "?"),
    ('"/a" + str(count + find())', "?"),
    ('Names.BELL', "?"),
]  # fmt: skip


@pytest.mark.parametrize(("before", "written", "name"), IN_CPP)
def test_cpp(before, written, name):
    made = f"{before} create_publisher<std_msgs::msg::Empty>({written}, 1);".replace("; ", ";\n    ")
    found = graph({"buoy/src/buoy.cpp": CPP.replace("HERE", made)})
    assert {one.topic if one.how == "literal" else "?" for one in found.endpoints} == {name}


@pytest.mark.parametrize(("written", "name"), IN_PYTHON)
def test_python(written, name):
    found = graph({"buoy/buoy.py": PYTHON.replace("HERE", f"self.create_publisher(Empty, {written}, 1)")})
    assert {one.topic if one.how == "literal" else "?" for one in found.endpoints} == {name}


def test_at_each_line_it_is_what_it_is_there():
    made = """
    std::string n = "/a";
    create_publisher<std_msgs::msg::Empty>(n, 1);
    n.insert(1, "b");
    create_publisher<std_msgs::msg::Empty>(n, 1);
    n = "/c";
    create_publisher<std_msgs::msg::Empty>(n, 1);
    """
    found = graph({"buoy/src/buoy.cpp": CPP.replace("HERE", made)})
    assert [one.topic or "?" for one in sorted(found.endpoints, key=lambda one: one.line)] == ["/a", "?", "/c"]
