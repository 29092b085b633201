"""ROS 1 nodes in C++: names, handles, types, callbacks, and what publishes where."""

import pytest
from joining import ends, graph
from rosimpact.impact.model.flow.nodes import BuiltPackage

TALKER = """
    #include <ros/ros.h>
    #include <std_msgs/String.h>
    int main(int argc, char** argv) {
      ros::init(argc, argv, "talker");
      ros::NodeHandle nh, pnh("~");
      std::string topic;
      pnh.param<std::string>("topic", topic, "chatter");
      ros::Publisher pub = nh.advertise<std_msgs::String>(topic, 10, true);
      ros::Publisher own = pnh.advertise<std_msgs::String>("state", 1);
      ros::Rate rate(10);
      while (ros::ok()) {
        std_msgs::String message;
        if (message.data.empty()) pub.publish(message);
        rate.sleep();
      }
    }
"""


def test_a_talker_with_a_private_handle_and_a_parameter():
    found = graph({"demo/src/talker.cpp": TALKER}, 1)
    (node,) = found.nodes
    assert (node.id, node.name, node.kind, node.executable) == ("demo/talker", "/talker", "executable", "talker")
    assert ends(found, "publisher") == {
        ("demo/talker", "/chatter", "std_msgs/String"),
        ("demo/talker", "/talker/state", "std_msgs/String"),
    }
    by_topic = {endpoint.topic: endpoint for endpoint in found.endpoints}
    assert by_topic["/chatter"].how == "default"
    assert by_topic["/chatter"].qos.durability == "transient_local"
    assert by_topic["/chatter"].qos.depth == 10
    assert by_topic["/talker/state"].how == "literal"
    (publish,) = found.publishes
    assert (publish.topic, publish.expression) == ("/chatter", "message")
    assert [(guard.kind, guard.text) for guard in publish.guards] == [
        ("while", "ros::ok()"),
        ("if", "message.data.empty()"),
    ]
    assert [trigger.kind for trigger in publish.triggers] == ["start"]
    assert found.coverage.calls == found.coverage.resolved == 3
    assert found.coverage.by_default == 2


CLASS = {
    "nav/include/nav/server.h": """
        #pragma once
        namespace nav {
        class Server {
         public:
          Server();
          void onScan(const sensor_msgs::LaserScan::ConstPtr& scan);
          bool onClear(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
         private:
          void send(const ros::TimerEvent&);
          ros::NodeHandle nh_;
          ros::NodeHandle private_nh_{"~"};
          ros::Publisher pub_;
          ros::Subscriber sub_;
          ros::Timer timer_;
          ros::ServiceServer service_;
          bool ready_ = false;
        };
        }
    """,
    "nav/src/server.cpp": """
        #include "nav/server.h"
        namespace nav {
        Server::Server() {
          pub_ = nh_.advertise<nav_msgs::Path>("plan", 1);
          sub_ = nh_.subscribe("scan", 5, &Server::onScan, this);
          timer_ = nh_.createTimer(ros::Duration(0.1), &Server::send, this);
          service_ = private_nh_.advertiseService("clear", &Server::onClear, this);
        }
        void Server::onScan(const sensor_msgs::LaserScan::ConstPtr& scan) { ready_ = true; }
        bool Server::onClear(std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; }
        void Server::send(const ros::TimerEvent&) {
          if (!ready_) return;
          pub_.publish(nav_msgs::Path());
        }
        }
    """,
    "nav/src/main.cpp": """
        #include "nav/server.h"
        int main(int argc, char** argv) {
          ros::init(argc, argv, "planner");
          nav::Server server;
          ros::spin();
        }
    """,
}


def test_a_class_over_three_files_belongs_to_the_program_that_makes_it():
    found = graph(CLASS, 1)
    assert ends(found, "publisher") == {("nav/main", "/plan", "nav_msgs/Path")}
    assert ends(found, "subscriber") == {("nav/main", "/scan", "sensor_msgs/LaserScan")}
    assert ends(found, "server") == {("nav/main", "/planner/clear", "std_srvs/Empty")}
    subscriber = next(e for e in found.endpoints if e.role == "subscriber")
    assert (subscriber.callback.name, subscriber.callback.path) == ("nav::Server::onScan", "nav/src/server.cpp")
    (publish,) = found.publishes
    assert [(guard.kind, guard.text) for guard in publish.guards] == [("unless", "!ready_")]
    assert [(trigger.kind, trigger.detail) for trigger in publish.triggers] == [("timer", "ros::Duration(0.1)")]
    (timer,) = found.timers
    assert timer.callback.name == "nav::Server::send"


@pytest.mark.parametrize(
    ("links", "node"),
    [
        ({"walker": ("core",)}, "p/walker"),
        ({"walker": ("zeta",), "zeta": ("core",)}, "p/walker"),
        ({}, "p/core"),  # of nobody's but the library's
    ],
)
def test_what_no_call_is_seen_to_reach_belongs_to_the_program_that_links_it(links, node):
    files = {
        "p/walker.cpp": 'int main(int argc, char** argv) { ros::init(argc, argv, "walker"); load("legs"); }',
        "p/core.cpp": 'void step(ros::NodeHandle& n) { ros::Publisher p = n.advertise<std_msgs::Bool>("/step", 1); }',
    }
    built = BuiltPackage("p", {"walker": ("p/walker.cpp",)}, {"core": ("p/core.cpp",)}, {}, {}, links)
    assert ends(graph(files, 1, built=(built,)), "publisher") == {(node, "/step", "std_msgs/Bool")}


def test_guards_of_the_only_caller_come_first():
    found = graph({"p/a.cpp": """
        class A {
          void cb(const std_msgs::Bool::ConstPtr& m) { if (m->data) { send(3); } }
          void send(int n) { for (int i = 0; i < n; i++) pub_.publish(m_); }
          A() { sub_ = nh_.subscribe("go", 1, &A::cb, this); pub_ = nh_.advertise<std_msgs::Int32>("n", 1); }
          ros::NodeHandle nh_; ros::Publisher pub_; ros::Subscriber sub_; std_msgs::Int32 m_;
        };
        int main(int c, char** v) { ros::init(c, v, "a"); A a; ros::spin(); }
    """}, 1)  # fmt: skip
    (publish,) = found.publishes
    assert [(guard.kind, guard.of) for guard in publish.guards] == [("if", "A::cb"), ("while", "A::send")]
    assert [(trigger.kind, trigger.detail) for trigger in publish.triggers] == [("subscriber", "go")]


def test_several_ways_keep_their_own_guards():
    found = graph({"p/a.cpp": """
        class A {
          void one(const std_msgs::Bool::ConstPtr& m) { if (m->data) send(); }
          void two(const std_msgs::Bool::ConstPtr& m) { if (!stopped_) send(); }
          void send() { pub_.publish(m_); }
          A() {
            one_ = nh_.subscribe("one", 1, &A::one, this);
            two_ = nh_.subscribe("two", 1, &A::two, this);
            pub_ = nh_.advertise<std_msgs::Int32>("n", 1);
          }
          ros::NodeHandle nh_; ros::Publisher pub_; ros::Subscriber one_, two_; std_msgs::Int32 m_; bool stopped_;
        };
        int main(int c, char** v) { ros::init(c, v, "a"); A a; ros::spin(); }
    """}, 1)  # fmt: skip
    (publish,) = found.publishes
    assert publish.guards == ()
    ways = {way.trigger.detail: [guard.text for guard in way.guards] for way in publish.by}
    assert ways == {"one": ["m->data"], "two": ["!stopped_"]}


def test_images_have_their_camera_info_beside_them():
    found = graph({"p/a.cpp": """
        class A : public nodelet::Nodelet {
          void onInit() override {
            it_.reset(new image_transport::ImageTransport(getPrivateNodeHandle()));
            sub_ = it_->subscribeCamera("in/image_raw", 1, &A::cb, this);
            pub_ = it_->advertise("out", 1);
          }
          void cb(const sensor_msgs::ImageConstPtr& i, const sensor_msgs::CameraInfoConstPtr& c) { pub_.publish(i); }
          boost::shared_ptr<image_transport::ImageTransport> it_;
          image_transport::CameraSubscriber sub_; image_transport::Publisher pub_;
        };
        PLUGINLIB_EXPORT_CLASS(A, nodelet::Nodelet)
    """}, 1)  # fmt: skip
    (node,) = found.nodes
    assert (node.kind, node.plugin) == ("nodelet", "A")
    topics = {(e.role, e.topic, e.type) for e in found.endpoints}
    assert topics == {
        ("subscriber", "/<A>/in/image_raw", "sensor_msgs/Image"),
        ("subscriber", "/<A>/in/camera_info", "sensor_msgs/CameraInfo"),
        ("publisher", "/<A>/out", "sensor_msgs/Image"),
    }
    assert [publish.topic for publish in found.publishes] == ["/<A>/out"]


def test_the_camera_info_that_image_transport_names_for_an_image():
    found = graph({"p/a.cpp": """
        int main(int argc, char** argv) {
          ros::init(argc, argv, "a");
          ros::NodeHandle n;
          ros::Publisher p = n.advertise<sensor_msgs::CameraInfo>(
            image_transport::getCameraInfoTopic("front/image_raw"), 1);
          ros::spin();
        }
    """}, 1)  # fmt: skip
    assert ends(found, "publisher") == {("p/a", "/front/camera_info", "sensor_msgs/CameraInfo")}


def test_filters_get_the_callback_of_their_synchronizer():
    found = graph({"p/a.cpp": """
        class A {
         public:
          A() : image_(nh_, "image", 1), sync_(Policy(10), image_, info_) {
            info_.subscribe(nh_, "info", 1);
            sync_.registerCallback(boost::bind(&A::both, this, _1, _2));
          }
          void both(const sensor_msgs::ImageConstPtr& a, const sensor_msgs::CameraInfoConstPtr& b) {}
          ros::NodeHandle nh_;
          typedef message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::CameraInfo> Policy;
          message_filters::Subscriber<sensor_msgs::Image> image_;
          message_filters::Subscriber<sensor_msgs::CameraInfo> info_;
          message_filters::Synchronizer<Policy> sync_;
        };
        int main(int c, char** v) { ros::init(c, v, "a"); A a; ros::spin(); }
    """}, 1)  # fmt: skip
    assert ends(found, "subscriber") == {
        ("p/a", "/image", "sensor_msgs/Image"),
        ("p/a", "/info", "sensor_msgs/CameraInfo"),
    }
    assert {e.callback.name for e in found.endpoints if not e.implied} == {"A::both"}


def test_callbacks_that_options_hold():
    found = graph({"p/a.cpp": """
        void first(const std_msgs::String::ConstPtr& msg) {}
        void second(const std_msgs::String::ConstPtr& msg) {}
        int main(int c, char** v) {
          ros::init(c, v, "a");
          ros::NodeHandle n;
          auto made = ros::SubscribeOptions::create<std_msgs::String>("one", 1, first, ros::VoidPtr(), &queue);
          ros::Subscriber a = n.subscribe(made);
          ros::SubscribeOptions told;
          told.init<std_msgs::String>("two", 1, second);
          ros::Subscriber b = n.subscribe(told);
          ros::spin();
        }
    """}, 1)  # fmt: skip
    assert [e.callback and e.callback.name for e in found.endpoints if e.role == "subscriber" and not e.implied] == [
        "first",
        "second",
    ]


def test_a_class_made_by_an_alias_that_is_spelt_with_its_namespace():
    found = graph(
        {
            "p/types.h": """
            namespace p {
            template<class T> class Filter {
             public:
              Filter() { pub_ = nh_.advertise<std_msgs::String>("state", 1); }
              ros::NodeHandle nh_;
              ros::Publisher pub_;
            };
            typedef Filter<Kalman> KalmanFilter;
            }
        """,
            "p/a.cpp": """
            #include "types.h"
            int main(int c, char** v) { ros::init(c, v, "a"); p::KalmanFilter filter; ros::spin(); }
        """,
            "p/b.cpp": """
            int main(int c, char** v) { ros::init(c, v, "b"); ros::NodeHandle nh; ros::spin(); }
        """,
        },
        1,
        built=(BuiltPackage("p", {"a": ("p/types.h", "p/a.cpp"), "b": ("p/types.h", "p/b.cpp")}, {}, {}, {}, {}),),
    )
    assert ends(found, "publisher") == {("p/a", "/state", "std_msgs/String")}


def test_a_name_served_and_listened_to_has_a_callback_for_each():
    found = graph({"p/a.cpp": """
        struct A {
          A() {
            server_ = nh_.advertiseService("path", &A::on, this);
            sub_ = nh_.subscribe("path", 1, &A::on, this);
          }
          bool on(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) { return true; }
          void on(const std_msgs::StringConstPtr& msg) {}
          ros::NodeHandle nh_;
          ros::ServiceServer server_;
          ros::Subscriber sub_;
        };
        int main(int c, char** v) { ros::init(c, v, "a"); A a; ros::spin(); }
    """}, 1)  # fmt: skip
    ended = {e.role: (e.type, e.callback and e.callback.line) for e in found.endpoints if not e.implied}
    assert ended == {"server": ("std_srvs/SetBool", 7), "subscriber": ("std_msgs/String", 8)}


@pytest.mark.parametrize(
    "filters",
    [
        "[message_filters.Subscriber('a', Image), message_filters.Subscriber('b', Image)]",
        "[message_filters.Subscriber(topic, Image) for topic in ('a', 'b')]",
    ],
)
def test_filters_without_a_name_get_the_callback_of_what_is_made_of_them(filters):
    found = graph({"p/a.py": f"""
        import message_filters
        import rospy
        from sensor_msgs.msg import Image

        def both(a, b):
            pass

        rospy.init_node("a")
        sync = message_filters.TimeSynchronizer({filters}, 10)
        sync.registerCallback(both)
        rospy.spin()
    """}, 1)  # fmt: skip
    subscribers = [e for e in found.endpoints if e.role == "subscriber" and not e.implied]
    assert [(e.topic, e.callback and e.callback.name) for e in subscribers] == [("/a", "both"), ("/b", "both")]


def test_a_publisher_passed_to_functions_and_bound():
    found = graph({"p/a.cpp": """
        void tick(const ros::TimerEvent&, ros::Publisher pub) { pub.publish(std_msgs::Empty()); }
        void say(ros::Publisher& p) { p.publish(std_msgs::Empty()); }
        int main(int c, char** v) {
          ros::init(c, v, "a");
          ros::NodeHandle nh;
          ros::Publisher out = nh.advertise<std_msgs::Empty>("/tick", 1);
          ros::Timer t = nh.createTimer(ros::Duration(1), boost::bind(tick, _1, out));
          say(out);
        }
    """}, 1)  # fmt: skip
    assert {publish.topic for publish in found.publishes} == {"/tick"}
    assert {trigger.kind for publish in found.publishes for trigger in publish.triggers} == {"timer", "start"}


def test_what_cannot_be_told_is_listed_with_its_reason():
    found = graph({"p/a.cpp": """
        int main(int c, char** v) {
          ros::init(c, v, "a");
          ros::NodeHandle nh;
          ros::Publisher pub = nh.advertise<std_msgs::Empty>(v[1], 1);
          pub.publish(std_msgs::Empty());
        }
    """}, 1)  # fmt: skip
    assert found.coverage.calls == 2
    assert found.coverage.resolved == 0
    assert [(u.what, u.line) for u in found.coverage.unresolved] == [("publisher name", 5), ("publish", 6)]
    (endpoint,) = [e for e in found.endpoints if not e.implied]
    assert (endpoint.topic, endpoint.how) == ("", "unresolved")
    assert endpoint.reason


def test_transforms_and_reconfigure_are_implied():
    found = graph({"p/a.cpp": """
        int main(int c, char** v) {
          ros::init(c, v, "a");
          tf::TransformListener listener;
          tf::TransformBroadcaster caster;
          dynamic_reconfigure::Server<p::AConfig> server;
          caster.sendTransform(tf::StampedTransform());
        }
    """}, 1)  # fmt: skip
    assert {(e.role, e.topic) for e in found.endpoints if e.implied} == {
        ("subscriber", "/tf"), ("subscriber", "/tf_static"), ("publisher", "/tf"), ("server", "/a/set_parameters"),
        ("publisher", "/a/parameter_descriptions"), ("publisher", "/a/parameter_updates"), ("publisher", "/rosout"),
        ("server", "/a/get_loggers"), ("server", "/a/set_logger_level"),
    }  # fmt: skip
    assert [publish.topic for publish in found.publishes] == ["/tf"]


def test_a_method_called_publish_is_followed():
    found = graph({"p/a.cpp": """
        class Cloud {
         public:
          explicit Cloud(ros::NodeHandle& nh) { pub_ = nh.advertise<sensor_msgs::PointCloud2>("cloud", 1); }
          void publish() { pub_.publish(cloud_); }
          ros::Publisher pub_; sensor_msgs::PointCloud2 cloud_;
        };
        int main(int c, char** v) {
          ros::init(c, v, "a");
          ros::NodeHandle nh;
          Cloud cloud(nh);
          while (ros::ok()) cloud.publish();
        }
    """}, 1)  # fmt: skip
    assert {(p.line, p.topic, p.through) for p in found.publishes} == {
        (5, "/cloud", ""),
        (12, "/cloud", "Cloud::publish"),
    }


def test_calls_of_other_classes_that_are_named_alike_are_none():
    found = graph({"p/a.cpp": """
        struct Magazine { void subscribe(const char* who, int n); void advertise(int pages); };
        int main(int c, char** v) {
          Magazine m;
          m.subscribe("me", 1);
          m.advertise(3);
          other.subscribe();
        }
    """}, 1)  # fmt: skip
    assert found.endpoints == ()
    assert found.coverage.calls == 0


CONTROLLER = """
    namespace wheels {
    class Drive : public Base {
     public:
      bool init(Hardware* hardware, ros::NodeHandle& root, ros::NodeHandle& own) {
        pub_ = own.advertise<std_msgs::Bool>("moving", 1);
        sub_ = root.subscribe("/stop", 1, &Drive::stop, this);
        ros::NodeHandle below(own, "deep");
        more_ = below.advertise<std_msgs::Bool>("more", 1);
        return true;
      }
      void stop(const std_msgs::Bool& message) { pub_.publish(message); }
      ros::Publisher pub_, more_;
      ros::Subscriber sub_;
    };
    }
    PLUGINLIB_EXPORT_CLASS(wheels::Drive, Base)
"""


def test_what_a_handle_from_elsewhere_names_is_not_known():
    """A global name is known whatever the handle is; a relative one is not at the root."""
    found = graph({"wheels/src/drive.cpp": CONTROLLER}, 1)
    told = {(e.written, e.topic, e.reason.partition(":")[0]) for e in found.endpoints if not e.implied}
    assert told == {
        ('"moving"', "", "`?/moving`"), ('"more"', "", "`?/deep/more`"), ('"/stop"', "/stop", ""),
    }  # fmt: skip
    assert [(publish.topic, publish.reason[:11]) for publish in found.publishes] == [("", "`?/moving`:")]
    assert {one.what for one in found.coverage.unresolved} == {"publisher name", "publish"}


@pytest.mark.parametrize(
    "handles, topic",
    [
        ("ros::NodeHandle n; Lamp lamp(n);", "/lit"),
        ('ros::NodeHandle n("~"); Lamp lamp(n);', "/node/lit"),
        ('ros::NodeHandle n("room"); Light lamp(n);', "/room/lit"),
        ('ros::NodeHandle own("room"); ros::NodeHandle n = own; Lamp lamp(n);', "/room/lit"),
        ('ros::NodeHandle n, own("~"); Lamp lamp(n); Lamp other(own);', "/lit /node/lit"),  # one each
        ('std::string where; ros::param::get("where", where); ros::NodeHandle n(where); Lamp lamp(n);', ""),
    ],
)
def test_handles_that_are_passed_on(handles, topic):
    """Through constructors, also of a class by another name."""
    main = """
        struct Lamp {
          explicit Lamp(ros::NodeHandle n) { pub_ = n.advertise<std_msgs::Bool>("lit", 1); }
          ros::Publisher pub_;
        };
        namespace shop { typedef Lamp Light; }
        int main(int argc, char** argv) { ros::init(argc, argv, "node"); %s ros::spin(); }
    """
    found = graph({"p/node.cpp": main % handles.replace("Light", "shop::Light")}, 1)
    assert {topic for _, topic, _ in ends(found, "publisher")} == set((topic or "?").split())


def test_a_class_without_a_name_may_derive_from_another():
    found = graph({"p/a.cpp": """
        struct Base { virtual void go(); ros::Publisher p; };
        struct : Base { void go() override { p.publish(1); } } one;
        int main() { ros::NodeHandle n; Base b; b.p = n.advertise<std_msgs::String>("a", 1); b.go(); }
    """}, 1)  # fmt: skip
    assert [(one.path, one.line) for one in found.publishes] == [("p/a.cpp", 3)]
