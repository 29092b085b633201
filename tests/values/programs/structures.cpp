// What callbacks are made of: state, virtual calls, templates, containers, lambdas, texts.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <sstream>
#include <unordered_map>

#include "kit.h"

struct Numbers { int32_t a, b; uint8_t small; double x; bool flag; };
struct Values { std::vector<int32_t> data; };
struct Text { std::string data; };

struct Behaviour { virtual ~Behaviour() = default; virtual int act(int value) const = 0; };
struct Divide : Behaviour { int act(int value) const override { return 100 / value; } };  // crash: virtual_call DIVISION
struct Keep : Behaviour { int act(int value) const override { return value; } };

void run_virtual_call(Publisher &pub, const Numbers &msg) {
  std::unique_ptr<Behaviour> behaviour;
  if (msg.flag) behaviour = std::make_unique<Divide>();
  else behaviour = std::make_unique<Keep>();
  pub.publish(behaviour->act(msg.a));
}
EXPLORE(virtual_call, Numbers, FIELD(flag); FIELD(a))  // also: handled

void run_cast(Publisher &pub, const Numbers &msg) {
  std::shared_ptr<Behaviour> behaviour;
  if (msg.small > 3) behaviour = std::make_shared<Keep>();
  else behaviour = std::make_shared<Divide>();
  auto *keep = dynamic_cast<Keep *>(behaviour.get());
  if (keep) pub.publish(keep->act(1));
}
EXPLORE(cast, Numbers, FIELD(small))  // also: handled, ignored

template <class T> T clampTo(T value, T low, T high) { return value < low ? low : value > high ? high : value; }
void run_templates(Publisher &pub, const Numbers &msg) {
  double kept = clampTo(msg.x, -1.0, 1.0);
  if (kept != msg.x) LOG_WARN("clamped");
  else pub.publish(kept);
}
EXPLORE(templates, Numbers, FIELD(x))  // also: handled, log-only

struct Counter {
  Publisher pub{"pub"};
  unsigned count_ = 0;
  std::vector<int> kept_;
  std::map<std::string, int> seen_;
  void on(const Numbers &msg) {
    if (msg.small == 0) return;
    if (count_ == 3) { assert(msg.small < 10); return; }  // crash: state ASSERTION
    count_ += 1;
  }
  void keep(const Numbers &msg) { if (msg.a > 0) kept_.push_back(msg.a); }
  void see(const Text &msg) { seen_[msg.data] += 1; }
};
HARNESS(state, Numbers, Counter, FIELD(small),
        ri_enter("this"); fill("count_", node.count_); ri_leave(); MEMBER(count_); node.on(message))  // also: handled, ignored
HARNESS(kept, Numbers, Counter, FIELD(a), MEMBER(kept_); node.keep(message))  // also: handled, ignored
HARNESS(seen, Text, Counter, FIELD(data), MEMBER(seen_); node.see(message))  // also: handled

void run_map_find(Publisher &pub, const Text &msg) {
  static const std::map<std::string, int> codes{{"go", 1}, {"stop", 2}, {"wait", 3}};
  auto found = codes.find(msg.data);
  if (found != codes.end()) pub.publish(found->second);
}
EXPLORE(map_find, Text, FIELD(data))  // also: handled, ignored

void run_unordered(Publisher &pub, const Text &msg) {
  static const std::unordered_map<std::string, int> codes{{"go", 1}, {"stop", 0}};
  auto found = codes.find(msg.data);
  if (found == codes.end()) return;
  pub.publish(10 / found->second);  // crash: unordered DIVISION
}
EXPLORE(unordered, Text, FIELD(data))  // also: handled, ignored

void run_unordered_numbers(Publisher &pub, const Numbers &msg) {
  std::unordered_map<int, int> codes{{1, 5}, {7, 6}};
  codes[3] = 7;
  if (codes.count(msg.small)) pub.publish(1);
}
EXPLORE(unordered_numbers, Numbers, FIELD(small))  // also: handled, ignored

void run_set(Publisher &pub, const Numbers &msg) {
  std::set<int> allowed{3, 1, 2};
  allowed.erase(2);
  if (allowed.count(msg.a)) pub.publish(1);
}
EXPLORE(set, Numbers, FIELD(a))  // also: handled, ignored

void run_lambda(Publisher &pub, const Numbers &msg) {
  int limit = 10;
  std::function<bool(int)> accepts = [&limit](int value) { return value < limit; };
  if (msg.flag) accepts = [](int value) { return value == 77; };
  if (accepts(msg.a)) pub.publish(1);
}
EXPLORE(lambda, Numbers, FIELD(flag); FIELD(a))  // also: handled, ignored

void run_no_function(Publisher &pub, const Numbers &msg) {
  std::function<void()> todo;
  if (msg.a != 0) todo = [&pub]() { pub.publish(1); };
  todo();  // crash: no_function EXCEPTION
}
EXPLORE(no_function, Numbers, FIELD(a))  // also: handled

void run_deque(Publisher &pub, const Values &msg) {
  std::deque<int32_t> window;
  for (int32_t each : msg.data) {
    window.push_back(each);
    if (window.size() > 2) window.pop_front();
  }
  if (window.size() == 2 && window[0] == 1 && window[1] == 2) pub.publish(1);
}
EXPLORE(deque, Values, FIELD(data))  // also: handled, ignored

void run_sorted(Publisher &pub, const Values &msg) {
  std::vector<int32_t> values = msg.data;
  std::sort(values.begin(), values.end());
  if (values.size() == 3 && values[1] == 50) pub.publish(values[1]);
}
EXPLORE(sorted, Values, FIELD(data))  // also: handled, ignored

void run_largest(Publisher &pub, const Values &msg) {
  auto largest = std::max_element(msg.data.begin(), msg.data.end());
  pub.publish(*largest);  // crash: largest NULL
}
EXPLORE(largest, Values, FIELD(data))  // also: handled

void run_summed(Publisher &pub, const Values &msg) {
  int64_t sum = std::accumulate(msg.data.begin(), msg.data.end(), int64_t{0});
  if (sum == 100) pub.publish(sum);
}
EXPLORE(summed, Values, FIELD(data))  // also: handled, ignored

void run_words(Publisher &pub, const Text &msg) {
  static std::string previous = "none";
  if (msg.data == "on") pub.publish(1);
  else if (msg.data == "off") pub.publish(0);
  else if (msg.data == previous) LOG_WARN("again");
  else if (msg.data.find('=') != std::string::npos) LOG_WARN("an assignment");
}
EXPLORE(words, Text, FIELD(data))  // also: handled, log-only, ignored

void run_prefix(Publisher &pub, const Text &msg) {
  if (msg.data.rfind("cmd:", 0) == 0) {
    std::string rest = msg.data.substr(4);
    std::transform(rest.begin(), rest.end(), rest.begin(), ::tolower);
    if (rest == "go") pub.publish(1);
  }
}
EXPLORE(prefix, Text, FIELD(data))  // also: handled, ignored

void run_joined(Publisher &pub, const Text &msg) {
  std::string topic = "/robot/" + msg.data + "/state";
  if (topic == "/robot/arm/state") pub.publish(1);
}
EXPLORE(joined, Text, FIELD(data))  // also: handled, ignored

void run_locked(Publisher &pub, const Numbers &msg) {
  static std::mutex mutex;
  static std::atomic<int> count{0};
  std::lock_guard<std::mutex> lock(mutex);
  count += 1;
  if (count.load() == 1 && msg.a > 0) pub.publish(1);
}
EXPLORE(locked, Numbers, FIELD(a))  // also: handled, ignored

void run_timed(Publisher &pub, const Numbers &msg) {
  auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  if (now > 5'000'000'000 && msg.flag) pub.publish(now);
}
EXPLORE(timed, Numbers, FIELD(flag))  // also: handled, ignored

void run_sine(Publisher &pub, const Numbers &msg) {
  if (std::sin(msg.x) > 2.0) pub.publish(1);
  if (std::sqrt(msg.x) > 3.0) pub.publish(2);
}
EXPLORE(sine, Numbers, FIELD(x))  // also: handled, ignored

void run_truths(Publisher &pub, const Numbers &msg) {
  std::vector<bool> seen(8, false);
  seen[msg.small & 7] = true;
  if (seen[5]) pub.publish(1);
}
EXPLORE(truths, Numbers, FIELD(small))  // also: handled, ignored

enum class Phase { Idle, Moving, Done };
void run_phases(Publisher &pub, const Numbers &msg) {
  switch (static_cast<Phase>(msg.small)) {
    case Phase::Idle: return;
    case Phase::Moving: pub.publish(1); return;
    case Phase::Done: LOG_WARN("done"); return;
  }
}
EXPLORE(phases, Numbers, FIELD(small))  // also: handled, log-only, ignored

void run_uninitialised(Publisher &pub, const Numbers &msg) {
  int mode;
  if (msg.a > 0) mode = 1;
  int kept = msg.flag ? mode : 0;
  if (kept == 1) pub.publish(kept);
}
EXPLORE(uninitialised, Numbers, FIELD(a); FIELD(flag))  // also: handled, ignored

extern int read_hardware(int);
void run_outside(Publisher &pub, const Numbers &msg) {
  if (read_hardware(msg.a) > 3) pub.publish(1);
}
EXPLORE(outside, Numbers, FIELD(a))  // also: handled, unknown
