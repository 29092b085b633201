"""How platform libraries and the compiler are used: what is seen in code, and which version refuses it."""

import re

import pytest
from rosimpact.impact.facts.usage import find_use_places
from rosimpact.impact.targets.changes import find_standards, iterate_in_force, load_uses
from rosimpact.impact.targets.distro.distro import DistroTarget


class Nothing:
    """A provider table that knows no release."""

    def has_header(self, *_):
        return None

    def list_header_spans(self, *_):
        return ()


class Machine(DistroTarget):
    """A target that only has libraries and packages of these versions."""

    def __init__(self, **versions: str):
        self.platform = "ubuntu focal"
        self.distro, self.ros, self.python_major = "noetic", 1, 3
        self.versions = {name.replace("_", "-"): version for name, version in versions.items()}

    def find_version(self, package):
        return self.versions.get(package)

    def find_oldest_library(self, name):
        return None

    def find_library(self, name):
        return self.versions.get(name)


def refused(code: str, **versions: str) -> set[str]:
    """Labels of the uses in code that a machine does not take, whatever the C++ standard."""
    states = {row.old: state for row, state in iterate_in_force(Machine(**versions), Nothing())}
    return {
        label
        for label, use in load_uses().items()
        if label in states and "::" not in use.pattern.word and list(find_use_places(code.encode(), use.pattern))
    }


BOOST = {"boost": "1.71.0"}
FFMPEG = {"ffmpeg_libavcodec": "6.1.1"}
LIBAV = {"libav": "9.20", "libavcodec": "54.35.0", "libavutil": "52.3.0"}
GAZEBO = {"gazebo_classic": "11"}

SLOTS = 'PyTypeObject T = {{PyVarObject_HEAD_INIT(nullptr, 0) "t", sizeof(T), 0, 0, {0}, {0}}};'

SNIPPETS = [
    ("wait(boost::posix_time::seconds(0.5));", BOOST, "boost::posix_time::seconds(floating point)"),
    ("wait(boost::posix_time::seconds(0.5));", {"boost": "1.65.1"}, ""),
    ("wait(boost::posix_time::seconds(5));", BOOST, ""),
    ("double t = 5; wait(boost::posix_time::seconds(t));", BOOST, "boost::posix_time::seconds(floating point)"),
    ("wait(boost::posix_time::milliseconds(static_cast<int>(t * 1000.0)));", BOOST, ""),
    ("ptree::xml_writer_settings<char> s(' ', 4);", BOOST, "boost::property_tree::xml_writer_settings<char>"),
    ("ptree::xml_writer_settings<std::string> s(' ', 4);", BOOST, ""),
    (
        "ptree::xml_writer_settings<std::string> s(' ', 4);",
        {"boost": "1.54.0"},
        "boost::property_tree::xml_writer_settings<std::string>",
    ),
    (
        "class A { friend class boost::serialization::singleton<A>; };",
        BOOST,
        "friend class boost::serialization::singleton<T>",
    ),
    ("boost::asio::io_service& s; io_service_.post(f);", {"boost": "1.90.0"}, "boost::asio::io_context::post()"),
    ("boost::asio::post(io_context_, f);", {"boost": "1.90.0"}, ""),
    (
        "asio::steady_timer t; t.expires_from_now(std::chrono::seconds(1));",
        {"boost": "1.90.0"},
        "boost::asio::basic_waitable_timer::expires_from_now()",
    ),
    ("void init() { import_array(); }", {"python": "3.8.2"}, "import_array() in a void function"),
    ("void* init() { import_array(); return 0; }", {"python": "3.8.2"}, ""),
    ("cv::ORB orb(500);", {"opencv": "3.2.0"}, "cv::ORB()"),
    ("cv::ORB orb(500);", {"opencv": "2.4.8"}, ""),
    ("cv::Ptr<cv::ORB> orb = cv::ORB::create(500);", {"opencv": "3.2.0"}, ""),
    ("class A { cv::StereoBM matcher_; };", {"opencv": "3.2.0"}, "an object of cv::StereoBM"),
    ('d = cv::FeatureDetector::create("ORB");', {"opencv": "3.2.0"}, "cv::FeatureDetector::create(name)"),
    ("p = cv::aruco::DetectorParameters::create();", {"opencv": "4.10.0"}, "cv::aruco::DetectorParameters::create()"),
    ("p = cv::aruco::DetectorParameters::create();", {"opencv": "4.6.0"}, ""),
    ("cv::aruco::ArucoDetector d(dict);", {"opencv": "4.6.0"}, "cv::aruco::ArucoDetector"),
    ("pcl::VoxelGrid<sensor_msgs::PointCloud2> f;", {"pcl": "1.7.2"}, "pcl::VoxelGrid<sensor_msgs::PointCloud2>"),
    (
        "pcl::PointCloud<P>::Ptr c = boost::make_shared<pcl::PointCloud<P> >();",
        {"pcl": "1.12.1"},
        "pcl::PointCloud::Ptr = boost::make_shared()",
    ),
    ("pcl::PointCloud<P>::Ptr c = boost::make_shared<pcl::PointCloud<P> >();", {"pcl": "1.10.0"}, ""),
    ('if (n.FindValue("a")) { YAML::Node m; }', {"yaml_cpp": "0.5.1"}, "YAML::Node::FindValue()"),
    ("w = format->streams[0]->codec->width;", FFMPEG, "AVStream::codec"),
    ("AVStream* video_stream; w = video_stream->codec->width;", FFMPEG, "AVStream::codec of a variable"),
    ("w = format->streams[0]->codecpar->width;", FFMPEG, ""),
    ("{ AVCodec* c = avcodec_find_encoder(id); }", FFMPEG, "AVCodec * = avcodec_find_encoder()"),
    ("{ const AVCodec* c = avcodec_find_encoder(id); }", FFMPEG, ""),
    ("frame = av_frame_alloc();", LIBAV, "av_frame_alloc()"),
    ("frame = av_frame_alloc();", {"libavutil": "54.31.100"}, ""),
    ("boost::shared_ptr<const urdf::Link> l;", {"urdfdom_headers": "1.0.4"}, "boost::shared_ptr<urdf::...>"),
    ("boost::shared_ptr<urdf::Model> m(new urdf::Model);", {"urdfdom_headers": "1.0.4"}, ""),
    ("boost::dynamic_pointer_cast<sensors::RaySensor>(s);", GAZEBO, "boost::dynamic_pointer_cast<sensors::...>"),
    ("boost::dynamic_pointer_cast<sensors::RaySensor>(s);", {"gazebo_classic": "5"}, ""),
    ('joint->SetParam("fmax", 0, 1.0);', {"gazebo_classic": "2"}, "physics::Joint::SetParam()"),
    ("n = world_->GetName();", GAZEBO, "physics::World::GetName()"),
    ("n = model_->GetName();", GAZEBO, ""),
    ("mapper->SetInput(reader->GetOutput());", {"vtk": "7.1.1"}, ""),
    ("vtkMapper* m; m->SetInput(reader->GetOutput());", {"vtk": "7.1.1"}, "vtkAlgorithm::SetInput()"),
    ("{ EVP_MD_CTX context; }", {"openssl": "1.1.1"}, "an object of EVP_MD_CTX"),
    ("{ EVP_MD_CTX* context; }", {"openssl": "1.1.1"}, ""),
    ("static char stack[SIGSTKSZ];", {"glibc": "2.35"}, "SIGSTKSZ as the size of an array"),
    ("ioctl(s, SIOCGSTAMP, &t);", {"linux_headers": "5.4"}, "SIOCGSTAMP"),
    ("#include <linux/sockios.h>\nvoid f() { ioctl(s, SIOCGSTAMP, &t); }", {"linux_headers": "5.4"}, ""),
    (
        "s = new g2o::OptimizationAlgorithmLevenberg(block);",
        {"libg2o": "2020.5.29"},
        "new g2o::OptimizationAlgorithmLevenberg(pointer)",
    ),
    ("boost::shared_ptr<ob::State> s; ompl::f();", {"ompl": "1.2.1"}, "boost::shared_ptr<ompl::...>"),
    ("bool f(double x) { return isnan(x); }", {"gcc": "5.4.0"}, "isnan() without std::"),
    ("bool f(double x) { return isnan(x); }", {"gcc": "7.5.0"}, ""),
    ("bool f(double x) { return std::isnan(x); }", {"gcc": "5.4.0"}, ""),
    ("using namespace std;\nbool f(double x) { return isnan(x); }", {"gcc": "5.4.0"}, ""),
    ("struct A { static const double X = 1.0; };", {"gcc": "9.4.0"}, "static const double = ... in a class"),
    ("struct A { static const int X = 1; };", {"gcc": "9.4.0"}, ""),
    ("void f() throw(std::bad_alloc);", {"gcc": "11.4.0"}, "throw(T) of a declaration"),
    ("void f() throw();", {"gcc": "11.4.0"}, ""),
    (
        "using namespace std;\nusing namespace boost;\nshared_ptr<int> p;",
        {"gcc": "9.4.0"},
        "shared_ptr of both std and boost",
    ),
    ("using namespace std;\nshared_ptr<int> p;", {"gcc": "9.4.0"}, ""),
    ("struct A { std::atomic<bool> on = false; };", {"gcc": "9.4.0"}, "std::atomic<T> x = ..."),
    ("std::atomic_bool on = false;", {"gcc": "9.4.0"}, "std::atomic_bool x = ..."),
    ("std::atomic<bool> on{false}; std::atomic<int> n = {1};", {"gcc": "9.4.0"}, ""),
    ("std::atomic<bool> on = ATOMIC_VAR_INIT(false);", {"gcc": "9.4.0"}, ""),
    ("void f(std::atomic<bool>& other) { std::atomic<bool>* on = &other; }", {"gcc": "9.4.0"}, ""),
    ("auto lock = std::lock_guard<std::mutex>(m);", {"gcc": "9.4.0"}, "auto x = std::lock_guard<T>(...)"),
    ("auto lock = std::unique_lock<std::mutex>(m);", {"gcc": "9.4.0"}, ""),
    ("auto rate = rclcpp::Rate(p.as_double());", {"gcc": "9.4.0"}, "auto x = rclcpp::Rate(...)"),
    ("auto rate = std::make_shared<rclcpp::Rate>(5);", {"gcc": "9.4.0"}, ""),
    (
        "auto e = rclcpp::executors::SingleThreadedExecutor();",
        {"gcc": "9.4.0"},
        "auto x = rclcpp::executors::SingleThreadedExecutor(...)",
    ),
    ("bool f() { return goal.header.stamp == rclcpp::Time(0); }", {"gcc": "11.4.0"}, "header.stamp == rclcpp::Time"),
    ("bool f() { return goal.header.stamp == rclcpp::Time(0); }", {"gcc": "13.2.0"}, ""),
    ("bool f() { return rclcpp::Time(goal.header.stamp) == now; }", {"gcc": "11.4.0"}, ""),
    ("yaml.load(stream)", {"pyyaml": "6.0.1"}, "yaml.load(stream) without a loader"),
    ("yaml.load(stream)", {"pyyaml": "5.4.1"}, ""),
    ("yaml.load(stream, Loader=yaml.SafeLoader)", {"pyyaml": "6.0.1"}, ""),
    ("yaml.load(*arguments)", {"pyyaml": "6.0.1"}, ""),
    ("finder = cv2.ORB()", {"opencv": "4.2.0"}, "cv2.ORB()"),
    ("finder = cv2.ORB(nfeatures=400)", {"opencv": "4.10.0"}, "cv2.ORB()"),
    ("finder = cv2.ORB()", {"opencv": "2.4.8"}, ""),
    ("finder = cv2.SIFT.create() if isinstance(it, cv2.ORB) else cv2.ORB_create()", {"opencv": "4.10.0"}, ""),
    (SLOTS.format("nullptr"), {"python": "3.8.2"}, "nullptr for tp_print"),
    (SLOTS.format("nullptr"), {"python": "3.6.9"}, ""),
    (SLOTS.format("NULL"), {"python": "3.8.2"}, ""),  # of which compilers only warn
]


@pytest.mark.parametrize(("code", "versions", "label"), SNIPPETS)
def test_what_a_library_refuses(code, versions, label):
    assert refused(code, **versions) == ({label} if label else set())


@pytest.mark.parametrize(
    ("label", "expected"),
    [
        ("std::optional", (0, 2017)),
        ("std::make_unique", (0, 2014)),
        ("isnan() without std::", (2011, 0)),
        ("throw(T) of a declaration", (2017, 0)),
        ("auto x = rclcpp::Rate(...)", (0, 2017)),
        ("header.stamp == rclcpp::Time", (2020, 0)),
        ("cv::ORB()", (0, 0)),
    ],
)
def test_what_depends_on_the_standard(label, expected):
    assert find_standards(label) == expected


@pytest.mark.parametrize("use", load_uses().values(), ids=lambda use: use.old)
def test_a_row_is_in_force_from_some_version_on_and_says_where_from(use):
    assert use.source and (use.removed_in or use.new_since)
    assert len(use.old) < 120


@pytest.mark.parametrize("use", load_uses().values(), ids=lambda use: use.old)
def test_a_row_has_expressions_that_can_be_read(use):
    p = use.pattern
    for expression in (p.before, p.template or "", p.after, p.file, p.unless, *p.where.values()):
        re.compile(expression)


LESS = "struct Less { bool operator()(int a, int b) const { return a < b; } };\nstd::set<int, Less> numbers;"


def test_a_comparison_has_to_be_const():
    assert refused(LESS, gcc="11.4.0") == set()
    assert refused(LESS.replace(" const ", " "), gcc="11.4.0") == {"a comparison of std::set that is not const"}
    assert refused(LESS.replace(" const ", " "), gcc="7.5.0") == set()
