// Callbacks of roscpp: each kind of crash, exceptions that are caught and not, state, a lookup of a transform.
#include <cassert>
#include <list>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int64.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

class Crashing
{
public:
  explicit Crashing(ros::NodeHandle &nh) : listener_(buffer_)
  {
    pub_ = nh.advertise<std_msgs::Int32>("out", 1);
    add(nh.subscribe("assertion", 1, &Crashing::onAssertion, this));
    add(nh.subscribe("table", 1, &Crashing::onTable, this));
    add(nh.subscribe("at", 1, &Crashing::onAt, this));
    add(nh.subscribe("front", 1, &Crashing::onFront, this));
    add(nh.subscribe("modulo", 1, &Crashing::onModulo, this));
    add(nh.subscribe("null", 1, &Crashing::onNull, this));
    add(nh.subscribe("dangling", 1, &Crashing::onDangling, this));
    add(nh.subscribe("narrow", 1, &Crashing::onNarrow, this));
    add(nh.subscribe("nan", 1, &Crashing::onNan, this));
    add(nh.subscribe("sum", 1, &Crashing::onSum, this));
    add(nh.subscribe("shift", 1, &Crashing::onShift, this));
    add(nh.subscribe("number", 1, &Crashing::onNumber, this));
    add(nh.subscribe("caught", 1, &Crashing::onCaught, this));
    add(nh.subscribe("other_caught", 1, &Crashing::onOtherCaught, this));
    add(nh.subscribe("endless", 1, &Crashing::onEndless, this));
    add(nh.subscribe("abort", 1, &Crashing::onAbort, this));
    add(nh.subscribe("counted", 1, &Crashing::onCounted, this));
    add(nh.subscribe("frame", 1, &Crashing::onFrame, this));
    add(nh.subscribe<std_msgs::UInt8>("bound", 1, boost::bind(&Crashing::onBound, this, _1, 3)));
  }

private:
  void add(const ros::Subscriber &one) { all_.push_back(one); }
  void send(int value)
  {
    std_msgs::Int32 out;
    out.data = value;
    pub_.publish(out);
  }
  void onAssertion(const std_msgs::Int32::ConstPtr &msg)
  {
    assert(msg->data >= 0);  // onAssertion ASSERTION
    send(msg->data);
  }
  void onTable(const std_msgs::UInt8::ConstPtr &msg)
  {
    static const int table[4] = {1, 2, 3, 4};
    send(table[msg->data]);  // onTable INDEX
  }
  void onAt(const std_msgs::UInt8::ConstPtr &msg)
  {
    std::vector<int> table{1, 2, 3};
    send(table.at(msg->data));  // onAt EXCEPTION
  }
  void onFront(const sensor_msgs::LaserScan::ConstPtr &msg)
  {
    if (msg->ranges.front() > 0.0f) send(1);  // onFront EMPTY
  }
  void onModulo(const std_msgs::Int32::ConstPtr &msg)
  {
    if (msg->data > 10) return;
    send(100 % msg->data);  // onModulo DIVISION
  }
  void onNull(const std_msgs::UInt8::ConstPtr &msg)
  {
    std::shared_ptr<int> held;
    if (msg->data != 7) held = std::make_shared<int>(msg->data);
    send(*held);  // onNull NULL
  }
  void onDangling(const std_msgs::UInt8::ConstPtr &msg)
  {
    std::unique_ptr<int> held(new int(msg->data));
    int *kept = held.get();
    if (msg->data > 100) held.reset();
    send(*kept);  // onDangling DANGLING
  }
  void onNarrow(const std_msgs::Float64::ConstPtr &msg)
  {
    if (!(msg->data > -1.0)) return;
    send(static_cast<uint16_t>(msg->data));  // onNarrow FLOAT_TO_INTEGER
  }
  void onNan(const std_msgs::Float64::ConstPtr &msg)
  {
    double part = msg->data;
    if (part > 1.0) part = 1.0;
    else if (part < 0.0) part = 0.0;
    send(static_cast<int>(part * 255));  // onNan FLOAT_TO_INTEGER
  }
  void onSum(const std_msgs::Int32::ConstPtr &msg)
  {
    send(msg->data + 10);  // onSum OVERFLOW
  }
  void onShift(const std_msgs::UInt8::ConstPtr &msg)
  {
    send(1 << (msg->data & 63));  // onShift SHIFT
  }
  void onNumber(const std_msgs::String::ConstPtr &msg)
  {
    send(std::stoi(msg->data));  // onNumber EXCEPTION
  }
  void onCaught(const std_msgs::String::ConstPtr &msg)
  {
    try
    {
      send(std::stoi(msg->data));
    }
    catch (const std::exception &error)
    {
      ROS_ERROR("no number: %s", error.what());
    }
  }
  void onOtherCaught(const std_msgs::UInt8::ConstPtr &msg)
  {
    try
    {
      if (msg->data == 1) throw std::runtime_error("one");
      if (msg->data == 2) throw std::logic_error("two");  // onOtherCaught EXCEPTION
      send(msg->data);
    }
    catch (const std::runtime_error &)
    {
      send(-1);
    }
  }
  void onEndless(const std_msgs::UInt8::ConstPtr &msg)
  {
    volatile uint8_t left = msg->data;
    while (left != 0)
    {
      if (left > 3) continue;  // onEndless ENDLESS
      left = left - 1;
    }
    send(1);
  }
  void onAbort(const std_msgs::UInt8::ConstPtr &msg)
  {
    if (msg->data == 255) abort();  // onAbort ABORT
    send(msg->data);
  }
  void onCounted(const std_msgs::UInt8::ConstPtr &msg)
  {
    if (++count_ == 3) assert(msg->data < 10);  // onCounted ASSERTION
    if (count_ > 5) send(1);
  }
  void onFrame(const geometry_msgs::PointStamped::ConstPtr &msg)
  {
    try
    {
      auto found = buffer_.lookupTransform("map", msg->header.frame_id, ros::Time(0));
      send(found.transform.translation.x > 1.0);
    }
    catch (const tf2::TransformException &error)
    {
      ROS_WARN("%s", error.what());
    }
  }
  void onBound(const std_msgs::UInt8::ConstPtr &msg, int least)
  {
    if (msg->data < least) return;
    send(msg->data);
  }

  ros::Publisher pub_;
  std::list<ros::Subscriber> all_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  unsigned count_ = 0;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "crashing");
  ros::NodeHandle nh;
  Crashing node(nh);
  ros::spin();
}
