"""Every row of the table of behaviour: what it finds, what it leaves alone, where it is from."""

import re

import pytest
from rosimpact.impact.facts.usage import find_use_places
from rosimpact.impact.targets.changes import DISTROS, behaves_differently, load_uses
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.distro.known import list_releases
from rosimpact.impact.targets.version import is_at_least

ROWS = load_uses("behaviour")

# label: a use that is found, and one like it that is not
EXAMPLES = {
    "cv::minAreaRect(points)": ("auto b = cv::minAreaRect(points);", "auto b = mine::minAreaRect(points);"),
    "cv2.minAreaRect(points)": ("b = cv2.minAreaRect(points)", "b = self.minAreaRect(points)"),
    "cv::aruco::CharucoBoard": ("cv::aruco::CharucoBoard board;", "cv::aruco::CharucoBoard b; b.setLegacyPattern(1);"),
    "cv2.aruco.CharucoBoard": ("b = cv2.aruco.CharucoBoard((5, 4), 1, 2, d)",
                               "b = cv2.aruco.CharucoBoard((5, 4), 1, 2, d)\nb.setLegacyPattern(True)"),
    "cv2.aruco.CharucoBoard_create": ("b = cv2.aruco.CharucoBoard_create(5, 4, 1, 2, d)", "CharucoBoard_create()"),
    "cv::findContours(image, ...)": ("cv::findContours(image, contours, mode, method);", "cv::findContours(a, b);"),
    "cv2.findContours(image, ...)": ("c, h = cv2.findContours(image, mode, method)", "c = findContours(i, m, n)"),
    "cv::waitKey(delay)": ("if (cv::waitKey(10) == 65361) {}", "if (cv::waitKey(10) == 27) {}"),
    "pcl::IterativeClosestPoint": ("pcl::IterativeClosestPoint<P, P> icp;",
                                   "pcl::IterativeClosestPoint<P, P> icp; icp.setTransformationRotationEpsilon(1);"),
    "pcl::BoxClipper3D": ("pcl::BoxClipper3D<P> clipper(m);", "BoxClipper3D<P> clipper(m);"),
    "pcl::NormalDistributionsTransform": ("pcl::NormalDistributionsTransform<P, P> ndt;",
                                          "NormalDistributionsTransform ndt;"),
    "pcl::PointXYZRGBA": ("pcl::PointXYZRGBA point;", "pcl::PointCloud<pcl::PointXYZRGBA> cloud;"),
    "np.array(..., copy=False)": ("np.array(x, copy=False)", "np.array(x, copy=True)"),
    "np.unique(..., return_inverse=True)": ("np.unique(x, return_inverse=True)",
                                            "np.unique(x, return_inverse=True, axis=0)"),
    "np.gradient(...)": ("g = np.gradient(x)", "dx, dy = np.gradient(x)"),
    "np.meshgrid(...)": ("grid = np.meshgrid(x, y)", "xs, ys = np.meshgrid(x, y)"),
    "np.atleast_1d(a, b)": ("both = np.atleast_1d(a, b)", "a, b = np.atleast_1d(a, b)"),
    "np.broadcast_arrays(...)": ("both = np.broadcast_arrays(a, b)", "a, b = np.broadcast_arrays(a, b)"),
    "np.sign(complex)": ("np.sign(complex(1, 2))", "np.sign(x)"),
    "repr(np.float64(...))": ("repr(np.float64(3))", "repr(x)"),
    "np.float32(...) with a Python number": ("y = np.float32(x) * 2.5", "y = np.float32(x)"),
    "np.linspace(..., dtype=int)": ("np.linspace(0, 1, 5, dtype=int)", "np.linspace(0, 1, 5, dtype=float)"),
    "multiprocessing.Process(...)": ("multiprocessing.Process(target=f)",
                                     "multiprocessing.set_start_method('fork')\nmultiprocessing.Process(target=f)"),
    "multiprocessing.Pool(...)": ("multiprocessing.Pool(4)", "Pool(4)"),
    "asyncio.get_event_loop()": ("asyncio.get_event_loop()", "asyncio.get_running_loop()"),
    "tarfile extractall() without a filter": ("import tarfile\nt.extractall(p)",
                                              "import tarfile\nt.extractall(p, filter='data')"),
    "f-string of a class of str and Enum": ("class Mode(str, Enum):\n    A = 'a'", "class Mode(Enum):\n    A = 1"),
    "random.sample(set)": ("random.sample(set(x), 2)", "random.sample(x, 2)"),
    "asyncio.wait([coroutine()])": ("asyncio.wait([run(), stop()])", "asyncio.wait(tasks)"),
    "xml.etree.ElementTree.tostring(...)": ("ET.tostring(root)", "tostring(root)"),
    "subprocess.check_output(...)": ("subprocess.check_output(a)", "subprocess.check_output(a).decode()"),
    "round(number)": ("n = round(x)", "n = round(x, 2)"),
    "dict.keys()[...]": ("k = d.keys()[0]", "k = list(d.keys())[0]"),
    "dict.values()[...]": ("k = d.values()[0]", "k = d.values()"),
    "map(...)[...]": ("m = map(f, x)[0]", "m = map(f, x)"),
    "filter(...)[...]": ("m = filter(f, x)[0]", "m = filter(f, x)"),
    "len(map(...))": ("len(map(f, x))", "len(list(map(f, x)))"),
    "len(filter(...))": ("len(filter(f, x))", "len(list(filter(f, x)))"),
    "len(zip(...))": ("len(zip(a, b))", "len(list(zip(a, b)))"),
    "rclcpp::executors::SingleThreadedExecutor": ("rclcpp::executors::SingleThreadedExecutor e;",
                                                  "SingleThreadedExecutor e;"),
    "rclcpp::executors::MultiThreadedExecutor by default": (
        "rclcpp::executors::MultiThreadedExecutor executor;", "rclcpp::executors::MultiThreadedExecutor e(o, 1);"),
    "MultiThreadedExecutor()": ("e = MultiThreadedExecutor()", "e = MultiThreadedExecutor(num_threads=1)"),
    "std::signal(SIGTERM, ...)": ("std::signal(SIGTERM, f); rclcpp::init(argc, argv);", "std::signal(SIGTERM, f);"),
    "node->undeclare_parameter(name)": ("node->undeclare_parameter(name);", "undeclare_parameter(name);"),
    "rclcpp::ParameterValue() as default": ("declare_parameter(name, rclcpp::ParameterValue());",
                                            "declare_parameter(name, rclcpp::ParameterValue(1));"),
    "self.undeclare_parameter(name)": ("self.undeclare_parameter(n)", "undeclare_parameter(n)"),
    "rclpy.shutdown() after an interrupt": ("try:\n    run()\nexcept KeyboardInterrupt:\n    pass\nrclpy.shutdown()",
                                            "rclpy.shutdown()"),
    "self.create_timer(period, callback)": ("self.create_timer(1.0, self.tick)", "self.create_timer(1.0, f, clock=c)"),
    "rosbag2_cpp::Writer::open(uri)": ("rosbag2_cpp::Writer writer; writer.open(uri);",
                                       "rosbag2_cpp::Writer writer; o.storage_id = s; writer.open(o);"),
    "rosbag2_py.StorageOptions(uri=...)": ("o = StorageOptions(uri=u)", "o = StorageOptions(uri=u, storage_id=s)"),
    "realtime_tools::RealtimePublisher": ("realtime_tools::RealtimePublisher<M> p;", "RealtimePublisher<M> p;"),
    "setToDefaultValues()": ("state->setToDefaultValues();", "setToDefaultValues();"),
    "setDefaultEntry(name, allowed)": ("acm.setDefaultEntry(name, true);", "acm.setEntry(name, true);"),
    "MoveGroupInterface without scaling factors": ('MoveGroupInterface group("arm");',
                                                   "MoveGroupInterface g(n); g.setMaxVelocityScalingFactor(1);"),
    "MoveGroupCommander.plan()": ("import moveit_commander\np = move_group.plan()", "p = move_group.plan()"),
    "sendTransform(...)": ("broadcaster.sendTransform(t);", "sendTransform(t);"),
    "br.sendTransform(...)": ("br.sendTransform(t)", "sendTransform(t)"),
    "rotation.eulerAngles(a0, a1, a2)": ("auto a = r.eulerAngles(2, 1, 0);", "auto a = r.eulerAngles(2, 1, 0, false);"),
    "controller_server without enable_stamped_cmd_vel": (
        "controller_server:\n  ros__parameters:\n    rate: 20.0\n",
        "controller_server:\n  ros__parameters:\n    enable_stamped_cmd_vel: false\n"),
    "points of a polygon as a list of numbers": (
        "    polygons: [stop]\n    stop:\n      points: [0.3, 0.3, 0.3, -0.3]\n",
        "    polygons: [stop]\n    stop:\n      points: \"[[0.3, 0.3], [0.3, -0.3]]\"\n"),
    "use_interpolation: false": ("  a:\n    use_interpolation: false\n", "  a:\n    # use_interpolation: false\n"),
    "primary_controller: name": ("  a:\n    primary_controller: dwb_core::DWBLocalPlanner\n",
                                 "  a:\n    primary_controller:\n      plugin: dwb_core::DWBLocalPlanner\n"),
    "planning_plugin: name": ("planning_plugin: ompl_interface/OMPLPlanner\n",
                              "planning_plugin: a/B\nplanning_plugins:\n  - a/B\n"),
    "request_adapters as a text": ("request_adapters: >-\n  a/B\n  a/C\n", "request_adapters:\n  - a/B\n  - a/C\n"),
    "xacro.process_file(path)": ("xacro.process_file(path)", "xacro.process_file(path, mappings=m)"),
}  # fmt: skip


def found(label: str, code: str) -> int:
    return len(list(find_use_places(code.encode(), ROWS[label].pattern)))


def test_every_row_has_an_example():
    assert EXAMPLES.keys() == ROWS.keys()


@pytest.mark.parametrize("label", ROWS)
def test_examples(label):
    there, not_there = EXAMPLES[label]
    assert (found(label, there), found(label, not_there)) == (1, 0)


@pytest.mark.parametrize("label", ROWS)
def test_each_row_says_who_says_so_and_what_is_other_now(label):
    row = ROWS[label]
    assert re.match(r"https://[\w./#-]+\Z", row.source)
    assert row.pattern.clause and not row.pattern.clause.endswith(".") and len(row.pattern.clause) < 140
    assert (row.pattern.language == "python") == bool(row.pattern.imports)
    assert label not in load_uses()


@pytest.mark.parametrize("label", [label for label, row in ROWS.items() if not row.library])
def test_versions_of_ros_packages_lie_between_released_ones(label):
    row = ROWS[label]
    versions = [version for _, version in list_releases(row.package)]
    assert row.removed_in in DISTROS or {is_at_least(version, row.removed_in) for version in versions} == {True, False}


def test_a_target_has_it_or_not_or_has_not_the_package():
    row = ROWS["cv::minAreaRect(points)"]
    targets = [DistroTarget("noetic"), DistroTarget("humble"), DistroTarget("humble", versions={"opencv": ""})]
    assert [behaves_differently(row, target) for target in targets] == [False, True, None]


def test_a_distro_as_bound_says_nothing_of_the_other_generation():
    row = ROWS["sendTransform(...)"]
    targets = map(DistroTarget, ("melodic", "noetic", "jazzy"))
    assert [behaves_differently(row, target) for target in targets] == [False, True, None]


def test_what_became_as_it_was_before_holds_in_between():
    row = ROWS["cv::minAreaRect(points)"]
    targets = [DistroTarget("jazzy", versions={"opencv": version}) for version in ("4.5", "4.5.1", "4.12", "4.13")]
    assert [behaves_differently(row, target) for target in targets] == [False, True, True, False]
