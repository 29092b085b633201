// Exceptions: what is caught, by whom, and what is not.
#include <map>
#include <stdexcept>

#include "kit.h"

struct Numbers { int32_t a; uint8_t small; };
struct Text { std::string data; };

struct SensorError : std::runtime_error { using std::runtime_error::runtime_error; };
struct DeepError : SensorError { using SensorError::SensorError; };
struct Code { int value; };
struct Tagged { virtual ~Tagged() = default; int tag = 4; };
struct Mixed : Tagged, std::logic_error { Mixed() : std::logic_error("mixed") {} };

void run_caught_base(Publisher &pub, const Text &msg) {
  try {
    pub.publish(std::stoi(msg.data));
  } catch (const std::exception &) {
    LOG_WARN("no number");
  }
}
EXPLORE(caught_base, Text, FIELD(data))  // also: handled, log-only

void run_caught_other(Publisher &pub, const Text &msg) {
  try {
    pub.publish(std::stoi(msg.data));  // crash: caught_other EXCEPTION
  } catch (const std::out_of_range &) {
    LOG_WARN("too large");
  }
}
EXPLORE(caught_other, Text, FIELD(data))  // also: handled

void run_caught_all(Publisher &pub, const Numbers &msg) {
  static const std::map<int, int> codes{{1, 10}, {2, 20}};
  try {
    pub.publish(codes.at(msg.a));
  } catch (...) {
  }
}
EXPLORE(caught_all, Numbers, FIELD(a))  // also: handled, ignored

void run_by_value(Publisher &pub, const Numbers &msg) {
  try {
    if (msg.a < 0) throw Code{msg.a};
    pub.publish(msg.a);
  } catch (Code code) {
    if (code.value == -5) pub.publish(code.value);
  }
}
EXPLORE(by_value, Numbers, FIELD(a))  // also: handled, ignored

void run_rethrown(Publisher &pub, const Numbers &msg) {
  try {
    if (msg.small == 9) throw SensorError("nine");
    if (msg.small == 8) throw std::invalid_argument("eight");
    pub.publish(msg.small);
  } catch (const std::runtime_error &) {
    throw;  // crash: rethrown EXCEPTION
  } catch (const std::logic_error &) {
    LOG_WARN("eight");
  }
}
EXPLORE(rethrown, Numbers, FIELD(small))  // also: handled, log-only

int deepen(int number) {
  if (number > 100) throw DeepError("deep");
  return number;
}
int pass(int number) {
  std::string kept = "a text that is freed while the exception passes: " + std::to_string(number & 3);
  return deepen(number) + static_cast<int>(kept.size() & 1);
}
void run_deep(Publisher &pub, const Numbers &msg) {
  try {
    pub.publish(pass(msg.a > 1000000 ? 1000000 : msg.a < 0 ? 0 : msg.a));
  } catch (const SensorError &error) {
    if (std::string(error.what()) == "deep") LOG_WARN("deep");
  }
}
EXPLORE(deep, Numbers, FIELD(a))  // also: handled, log-only

void run_thrown_number(Publisher &pub, const Numbers &msg) {
  try {
    if (msg.small > 3) throw 7;
    if (msg.small > 2) throw "text";  // crash: thrown_number EXCEPTION
    pub.publish(msg.small);
  } catch (int number) {
    if (number == 7) LOG_WARN("seven");
  }
}
EXPLORE(thrown_number, Numbers, FIELD(small))  // also: handled, log-only

void give(int number) noexcept {
  if (number == 3) throw std::runtime_error("three");  // crash: from_noexcept EXCEPTION
}
void run_from_noexcept(Publisher &pub, const Numbers &msg) {
  try {
    give(msg.small);
    pub.publish(1);
  } catch (...) {
    LOG_WARN("never");
  }
}
EXPLORE(from_noexcept, Numbers, FIELD(small))  // also: handled

void run_second_base(Publisher &pub, const Numbers &msg) {
  try {
    if (msg.small == 1) throw Mixed();
    pub.publish(1);
  } catch (const std::logic_error &error) {
    if (error.what()[0] == 'm') LOG_WARN("mixed");
  }
}
EXPLORE(second_base, Numbers, FIELD(small))  // also: handled, log-only

void run_nested(Publisher &pub, const Text &msg) {
  try {
    try {
      pub.publish(std::stoi(msg.data));
    } catch (const std::invalid_argument &) {
      throw SensorError("inner");
    }
  } catch (const SensorError &) {
    LOG_WARN("outer");
  }
}
EXPLORE(nested, Text, FIELD(data))  // also: handled, log-only
