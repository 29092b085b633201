// The parts of roscpp that talk to a master and to sockets, in one process: a node is compiled with the real headers of
// ROS 1 and linked with this. publish() serializes with the generated code; what subscribers are called with is
// deserialized from these bytes by roscpp's own callback helpers.
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace {
struct Hearing {
  std::string topic, md5sum;
  ros::SubscriptionCallbackHelperPtr helper;
};

std::vector<Hearing>& hearings() {
  static std::vector<Hearing> all;
  return all;
}

std::map<std::string, size_t>& sizes() {
  static std::map<std::string, size_t> all;
  return all;
}

void fail(const std::string& why) {
  std::cout << "FAILED " << why << std::endl;
  std::exit(3);
}

std::string resolve(const std::string& name) { return name[0] == '/' ? name : "/" + name; }
}  // namespace

namespace ros {
void init(int&, char**, const std::string&, uint32_t) { Time::init(); }
bool ok() { return true; }
void spin() {}
void spinOnce() {}

Publisher::Impl::Impl() : unadvertised_(false), latch_(false) {}
Publisher::Impl::~Impl() {}
bool Publisher::Impl::isValid() const { return !unadvertised_; }
Publisher::Publisher(
  const std::string& topic, const std::string& md5sum, const std::string& datatype, bool latch, const NodeHandle&,
  const SubscriberCallbacksPtr&)
: impl_(boost::make_shared<Impl>()) {
  impl_->topic_ = topic;
  impl_->md5sum_ = md5sum;
  impl_->datatype_ = datatype;
  impl_->latch_ = latch;
}
Publisher::Publisher(const Publisher& other) : impl_(other.impl_) {}
Publisher::~Publisher() {}
uint32_t Publisher::getNumSubscribers() const {
  uint32_t count = 0;
  for (const Hearing& one : hearings()) count += one.topic == impl_->topic_;
  return count;
}
std::string Publisher::getTopic() const { return impl_->topic_; }

void Publisher::publish(const boost::function<SerializedMessage(void)>& serialize, SerializedMessage& message) const {
  if (message.type_info && message.message == nullptr) fail("an empty pointer is published");
  const SerializedMessage made = serialize();
  sizes()[impl_->topic_] += made.num_bytes;
  for (size_t i = 0; i < hearings().size(); ++i) {
    const Hearing one = hearings()[i];
    if (one.topic != impl_->topic_) continue;
    if (one.md5sum != "*" && one.md5sum != impl_->md5sum_) fail("types differ on " + one.topic);
    SubscriptionCallbackHelperDeserializeParams given;
    given.buffer = made.message_start;
    given.length = made.num_bytes - (made.message_start - made.buf.get());
    boost::shared_ptr<M_string> header = boost::make_shared<M_string>();
    (*header)["callerid"] = "/node";
    given.connection_header = header;
    const VoidConstPtr read = one.helper->deserialize(given);
    SubscriptionCallbackHelperCallParams call;
    call.event = MessageEvent<void const>(read, header, Time(1), true, MessageEvent<void const>::CreateFunction());
    one.helper->call(call);
  }
}

NodeHandle::NodeHandle(const std::string&, const M_string&) : collection_(nullptr) {}
NodeHandle::NodeHandle(const NodeHandle& other) : collection_(nullptr) { (void)other; }
NodeHandle::~NodeHandle() {}
Publisher NodeHandle::advertise(AdvertiseOptions& ops) {
  return Publisher(resolve(ops.topic), ops.md5sum, ops.datatype, ops.latch, *this, SubscriberCallbacksPtr());
}
Subscriber NodeHandle::subscribe(SubscribeOptions& ops) {
  hearings().push_back({resolve(ops.topic), ops.md5sum, ops.helper});
  return Subscriber();
}
}  // namespace ros

// The nodes of a workspace, those that subscribe first: each is compiled with another name for its `main`.
__attribute__((weak)) int run_node0(int, char**);
__attribute__((weak)) int run_node1(int, char**);
__attribute__((weak)) int run_node2(int, char**);
__attribute__((weak)) int run_node3(int, char**);

int main(int argc, char** argv) {
  for (auto run : {run_node0, run_node1, run_node2, run_node3}) {
    if (run) run(argc, argv);
  }
  for (const auto& one : sizes()) std::fprintf(stderr, "%s %zu\n", one.first.c_str(), one.second);
  std::cout << std::flush;
  std::fflush(stdout);
  std::fflush(stderr);
  std::_Exit(0);
}
