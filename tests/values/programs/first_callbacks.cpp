// Ten callbacks as they occur on robots: enumerations, clamps, texts, arrays, divisions, state.
#include "kit.h"

struct LedMessage { enum : uint8_t { BLACK = 0, GREEN = 1, ORANGE = 2, RED = 3 }; uint8_t value; };
struct ModeMessage { enum : int32_t { IDLE = 0, RUN = 1, STOP = 2 }; int32_t mode; };
struct Vector3 { double x, y, z; };
struct Twist { Vector3 linear, angular; };
struct Text { std::string data; };
struct Joints { std::vector<std::string> name; std::vector<double> position; };
struct Rate { int32_t period_ms, count; };
struct Quaternion { double x, y, z, w; };
struct Pose { Vector3 position; Quaternion orientation; };
struct Header { uint32_t seq; std::string frame_id; };
struct PoseStamped { Header header; Pose pose; };
struct Command { uint32_t seq; uint8_t mode; };
struct Scan { float range_min, range_max; std::vector<float> ranges; };
struct Grid { uint32_t width, height; std::vector<int8_t> data; };

struct Node {
  Publisher pub{"pub"};
  double limit_ = 0.5;
  bool enabled_ = false;
  uint32_t last_seq_ = 0;
  int state_ = 0;
  int rate_ = 0;
  double commands_[6] = {};
  Pose goal_{};
  uint8_t costs_[16] = {};
  std::string map_frame_ = "map";

  void onLed(const LedMessage &msg) {
    switch (msg.value) {
      case LedMessage::GREEN: pub.publish(1); break;
      case LedMessage::ORANGE: pub.publish(2); break;
      case LedMessage::BLACK: pub.publish(0); break;
      default: LOG_WARN("not a color"); break;
    }
  }
  void onMode(const ModeMessage &msg) {
    switch (msg.mode) {
      case ModeMessage::IDLE: state_ = 10; break;
      case ModeMessage::RUN: state_ = 11; pub.publish(state_); break;
    }
  }
  void onVelocity(const Twist &msg) {
    double speed = msg.linear.x;
    if (std::fabs(msg.angular.z) < 0.01) return;
    if (speed > limit_) speed = limit_;
    else if (speed < -limit_) speed = -limit_;
    int32_t ticks = static_cast<int32_t>(speed * 100);  // crash: velocity FLOAT_TO_INTEGER
    pub.publish(ticks);
  }
  void onText(const Text &msg) {
    if (msg.data == "start") { enabled_ = true; pub.publish(1); }
    else if (msg.data == "stop") { enabled_ = false; pub.publish(0); }
    else if (msg.data.substr(0, 3) == "go ") { pub.publish(std::stoi(msg.data.substr(3))); }  // crash: text EXCEPTION
  }
  void onJoints(const Joints &msg) {
    for (size_t i = 0; i < msg.name.size(); ++i) commands_[i] = msg.position[i];  // crash: joints INDEX
    if (!msg.name.empty()) pub.publish(commands_[0]);
  }
  void onRate(const Rate &msg) {
    if (msg.count < 0) return;
    rate_ = 1000 / msg.period_ms;  // crash: rate DIVISION
    if (rate_ > 0) pub.publish(rate_ * (msg.count % 7));
  }
  bool isUnit(const Quaternion &q) {
    double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return std::fabs(norm - 1.0) < 0.1;
  }
  void onGoal(const PoseStamped &msg) {
    if (msg.header.frame_id != map_frame_) { LOG_WARN("frame"); return; }
    if (!isUnit(msg.pose.orientation)) return;
    goal_ = msg.pose;
    pub.publish(goal_);
  }
  void onCommand(const Command &msg) {
    if (msg.seq <= last_seq_) return;
    last_seq_ = msg.seq;
    if (!enabled_) return;
    assert(msg.mode < 3);  // crash: command ASSERTION
    pub.publish(msg.mode);
  }
  void onScan(const Scan &msg) {
    float best = msg.range_max;
    size_t place = 0;
    for (size_t i = 0; i < msg.ranges.size(); ++i) {
      float range = msg.ranges[i];
      if (range < msg.range_min) continue;
      if (range < best) { best = range; place = i; }
    }
    float ahead = msg.ranges[msg.ranges.size() / 2];  // crash: scan INDEX
    if (best < 0.3f && ahead < 1.0f) pub.publish(place);
  }
  void onGrid(const Grid &msg) {
    unsigned index = 0;
    for (unsigned i = 0; i < msg.height; ++i)
      for (unsigned j = 0; j < msg.width; ++j) {
        unsigned char value = msg.data[index];  // crash: grid INDEX
        costs_[index & 15] = value >= 100 ? 254 : 0;
        ++index;
      }
    if (index) pub.publish(index);
  }
};

#define STATE                                                                                                          \
  MEMBER(enabled_); MEMBER(last_seq_); MEMBER(state_); MEMBER(rate_); MEMBER(commands_); MEMBER(goal_); MEMBER(costs_)

HARNESS(led, LedMessage, Node, FIELD(value), STATE; node.onLed(message))  // also: handled, log-only
HARNESS(mode, ModeMessage, Node, FIELD(mode), STATE; node.onMode(message))  // also: handled, ignored
HARNESS(velocity, Twist, Node, FIELD(linear.x); FIELD(angular.z), STATE; node.onVelocity(message))  // also: handled, ignored
HARNESS(text, Text, Node, FIELD(data), STATE; node.onText(message))  // also: handled, ignored
HARNESS(joints, Joints, Node, FIELD(name); FIELD(position), STATE; node.onJoints(message))  // also: handled, ignored
HARNESS(rate, Rate, Node, FIELD(period_ms); FIELD(count), STATE; node.onRate(message))  // also: handled, ignored
HARNESS(goal, PoseStamped, Node,
        FIELD(header.frame_id); FIELD(pose.orientation.x); FIELD(pose.orientation.y); FIELD(pose.orientation.z);
        FIELD(pose.orientation.w); FIELD(pose.position.x),
        STATE; node.onGoal(message))  // also: handled, log-only, ignored
HARNESS(command, Command, Node, FIELD(seq); FIELD(mode),
        ri_enter("this"); fill("enabled_", node.enabled_); fill("last_seq_", node.last_seq_); ri_leave(); STATE;
        node.onCommand(message))  // also: handled, ignored
HARNESS(scan, Scan, Node, FIELD(range_min); FIELD(range_max); FIELD(ranges), STATE; node.onScan(message))  // also: handled, ignored
HARNESS(grid, Grid, Node, FIELD(width); FIELD(height); FIELD(data), STATE; node.onGrid(message))  // also: handled, ignored, unknown
