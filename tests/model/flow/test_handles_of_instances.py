"""Node handles whose namespace another caller, object or line gives: each instance has its own names."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

HEAD = """
    #include <ros/ros.h>
    #include <std_msgs/Empty.h>
    using std_msgs::Empty;
"""


def list_topics(body: str, main: str) -> dict[str, str]:
    """The topics that a program publishes, with the condition that each has."""
    code = f'{HEAD}{body}\nint main(int argc, char ** argv) {{ ros::init(argc, argv, "it");\n{main}\n}}'
    found = graph({"p/it.cpp": code}, ros=1)
    assert {one.node for one in found.endpoints} == {"p/it"}
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    return {one.topic or "?": one.only_if for one in made}


PART = """
    class Part {
     public:
      Part(const ros::NodeHandle & nh, const std::string & name) : nh_(nh, name), name_(name) {}
      void start() { pub_ = nh_.advertise<Empty>(name_ + "_state", 1); }
      ros::NodeHandle nh_;
      ros::Publisher pub_;
      std::string name_;
    };
"""
SET = """
    class Part {
     public:
      void init(const std::string & name, ros::NodeHandle * parent) { nh_ = ros::NodeHandle(*parent, name); }
      void start() { pub_ = nh_.advertise<Empty>("x", 1); }
      ros::NodeHandle nh_;
      ros::Publisher pub_;
    };
"""
BASE = """
    class Base {
     public:
      explicit Base(const std::string & space) : nh_(space) {}
      void start() { pub_ = nh_.advertise<Empty>("state", 1); }
      ros::NodeHandle nh_;
      ros::Publisher pub_;
    };
    class A : public Base { public: A() : Base("a") {} };
    class B : public Base { public: B() : Base("b") {} };
"""


@pytest.mark.parametrize(("body", "main", "expected"), [
    # One object has one name.
    (PART, 'ros::NodeHandle nh; Part one(nh, "left"); one.start();', {"/left/left_state"}),
    # Of two, what belongs together.
    (PART, 'ros::NodeHandle nh("~"); Part one(nh, "left"); Part two(nh, "right"); one.start(); two.start();',
     {"/it/left/left_state", "/it/right/right_state"}),
    (SET, 'ros::NodeHandle nh, own("~"); Part x, y; x.init("a", &nh); y.init("b", &own); x.start(); y.start();',
     {"/a/x", "/it/b/x"}),
    (BASE, "A a; B b; a.start(); b.start();", {"/a/state", "/b/state"}),
    # A function that is called with several handles.
    ("void help(ros::NodeHandle & nh, const std::string & name) { static auto p = nh.advertise<Empty>(name, 1); }",
     'ros::NodeHandle nh, own("~"); help(nh, "a"); help(own, "b");', {"/a", "/it/b"}),
    # Members of a class, and what is put into a list.
    (PART + """
     class Robot {
      public:
       Robot() : nh_("~"), left_(nh_, "left"), right_(nh_, "right") {
         parts_.emplace_back(nh_, "one");
         parts_.push_back(Part(nh_, "two"));
         last_.reset(new Part(nh_, "three"));
         left_.start(); right_.start(); last_->start();
         for (auto & each : parts_) each.start();
       }
       ros::NodeHandle nh_;
       Part left_, right_;
       std::vector<Part> parts_;
       std::unique_ptr<Part> last_;
     };""", "Robot robot;",
     {f"/it/{name}/{name}_state" for name in ("left", "right", "one", "two", "three")}),
    # In each turn of a loop.
    (BASE, 'for (int i = 0; i < 2; ++i) { Base part("n" + std::to_string(i)); part.start(); }',
     {"/n0/state", "/n1/state"}),
    # What is not known is not that of another.
    (BASE, "Base one(argv[1]); one.start();", {"?"}),
])  # fmt: skip
def test_each_instance_has_the_names_of_its_own_handle(body, main, expected):
    assert list_topics(body, main) == dict.fromkeys(expected, "")


@pytest.mark.parametrize(("main", "expected"), [
    ('nh = ros::NodeHandle("one");\nauto a = nh.advertise<Empty>("a", 1);\nnh = ros::NodeHandle("two");\n'
     'auto b = nh.advertise<Empty>("b", 1);', {"/one/a": "", "/two/b": ""}),
    ('if (argc > 2) {\nnh = ros::NodeHandle("~");\n}\nauto a = nh.advertise<Empty>("a", 1);',
     {"/it/a": "argc > 2", "/a": "the node handle is not replaced"}),
    ('if (argc > 2) {\nnh = ros::NodeHandle("~");\n} else {\nnh = ros::NodeHandle("x");\n}\n'
     'auto a = nh.advertise<Empty>("a", 1);', {"/it/a": "argc > 2", "/x/a": "!(argc > 2)"}),
    ('ros::NodeHandle own(argc > 1 ? "~" : "");\nauto a = own.advertise<Empty>("a", 1);',
     {"/it/a": "argc > 1", "/a": "!(argc > 1)"}),
    ('ros::NodeHandle two[2] = {ros::NodeHandle("x"), ros::NodeHandle("y")};\n'
     'auto a = two[1].advertise<Empty>("a", 1);', {"?": ""}),
    ('std::vector<ros::NodeHandle> one;\none.push_back(ros::NodeHandle("x"));\n'
     'auto a = one[0].advertise<Empty>("a", 1);', {"/x/a": ""}),
    ('ros::NodeHandle deep(ros::this_node::getName() + "/deep");\nauto a = deep.advertise<Empty>("a", 1);',
     {"/it/deep/a": ""}),
])  # fmt: skip
def test_the_handle_is_what_it_is_on_that_line(main, expected):
    assert list_topics("", f"ros::NodeHandle nh;\n{main}") == expected


def test_a_handle_that_is_made_where_the_member_stands():
    body = """
        class Part {
         public:
          ros::NodeHandle own_{"~"};
          ros::NodeHandle other_ = ros::NodeHandle("other");
          ros::Publisher a_ = own_.advertise<Empty>("a", 1);
          ros::Publisher b_ = other_.advertise<Empty>("b", 1);
        };
    """
    assert list_topics(body, "Part part;") == {"/it/a": "", "/other/b": ""}


def test_the_name_of_a_handle_that_a_parameter_gives_is_the_default():
    main = 'std::string s;\nros::param::param<std::string>("~space", s, "five");\nros::NodeHandle nh(s);'
    found = graph({"p/it.cpp": f"""{HEAD}
        int main(int argc, char ** argv) {{ ros::init(argc, argv, "it");
          {main}
          auto a = nh.advertise<Empty>("a", 1);
        }}"""}, ros=1)  # fmt: skip
    assert [(one.topic, one.how) for one in found.endpoints if not one.implied] == [("/five/a", "default")]


def test_a_program_has_the_handle_that_it_gives():
    main = '#include "part.hpp"\nint main(int argc, char ** argv) { ros::init(argc, argv, "N"); GIVEN }'
    given = {"one": "a", "two": "b"}
    mains = {
        f"p/{name}.cpp": main.replace("GIVEN", f'ros::NodeHandle nh; Part p(nh, "{space}"); p.start();')
        for name, space in given.items()
    }
    found = graph({"p/part.hpp": HEAD + PART, **mains}, ros=1)
    assert {(node, topic) for node, topic, _ in ends(found, "publisher")} == {
        ("p/one", "/a/a_state"), ("p/two", "/b/b_state"),
    }  # fmt: skip


def test_arguments_that_belong_together_stay_together_in_python():
    found = graph({"p/it.py": """
        import rospy
        from std_msgs.msg import Empty

        class Part:
            def __init__(self, a, b):
                self.a = a
                self.b = b

            def start(self):
                self.pub = rospy.Publisher(self.a + "/" + self.b, Empty)

        rospy.init_node("n")
        x = Part("x", "1")
        y = Part("y", "2")
        x.start()
        y.start()
    """}, ros=1)  # fmt: skip
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/x/1", "/y/2"}


@pytest.mark.parametrize(("name", "topic"), [('"y"', "/space/y"), ('"~/y"', "/n/y"), ('"/y"', "/y")])
def test_a_sub_node_puts_relative_names_into_its_namespace(name, topic):
    found = graph({"p/n.cpp": f"""
        #include <rclcpp/rclcpp.hpp>
        int main(int argc, char ** argv) {{
          rclcpp::init(argc, argv);
          auto node = std::make_shared<rclcpp::Node>("n");
          auto below = node->create_sub_node("space");
          auto pub = below->create_publisher<std_msgs::msg::Empty>({name}, 1);
          rclcpp::spin(node);
        }}
    """})  # fmt: skip
    assert {topic for _, topic, _ in ends(found, "publisher")} == {topic}


@pytest.mark.parametrize(("handle", "expected"), [
    # roscpp takes the slash away: it is the namespace of the node, or that of the handle around.
    ('ros::NodeHandle nh("/");', "/left/state"),
    ('ros::NodeHandle own("~"), nh(own, "/");', "/left/it/state"),
    ('ros::NodeHandle nh("/arm/");', "/arm/state"),
    ('ros::NodeHandle nh("/arm");', "/arm/state"),
    ("ros::NodeHandle nh;", "/left/state"),
])  # fmt: skip
def test_a_slash_alone_is_no_other_namespace(tmp_path, handle, expected):
    main = f'{handle} ros::Publisher state = nh.advertise<Empty>("state", 1); ros::spin();'
    code = f'{HEAD}\nint main(int argc, char ** argv) {{ ros::init(argc, argv, "it");\n{main}\n}}'
    found = graph_on_disk(tmp_path, {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\nadd_executable(it it.cpp)\n",
        "p/it.cpp": code,
        "p/left.launch": '<launch><group ns="left"><node pkg="p" type="it" name="it"/></group></launch>',
    })  # fmt: skip
    assert ends(found, "publisher") >= {("/left/it", expected, "std_msgs/Empty")}
