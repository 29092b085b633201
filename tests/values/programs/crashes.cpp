// Each kind of crash. The line of each is marked: `crash: ENTRY KIND`; what else may happen, beside the entry.
#include <array>
#include <climits>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <variant>

#include "kit.h"

struct Numbers { int32_t a, b; uint8_t small; int64_t wide; double x, y; float f; bool flag; };
struct Values { std::vector<int32_t> data; std::vector<double> weights; };
struct Text { std::string data; };

void run_assertion(Publisher &pub, const Numbers &msg) {
  assert(msg.a >= 0 && "not negative");  // crash: assertion ASSERTION
  pub.publish(msg.a);
}
EXPLORE(assertion, Numbers, FIELD(a))  // also: handled

void run_raw_index(Publisher &pub, const Numbers &msg) {
  static const int table[4] = {1, 2, 3, 4};
  pub.publish(table[msg.small]);  // crash: raw_index INDEX
}
EXPLORE(raw_index, Numbers, FIELD(small))  // also: handled

void run_vector_index(Publisher &pub, const Values &msg) {
  pub.publish(msg.data[1]);  // crash: vector_index INDEX
}
EXPLORE(vector_index, Values, FIELD(data))  // also: handled

void run_pointer_index(Publisher &pub, const Values &msg) {
  const int32_t *start = msg.data.data();
  int sum = 0;
  for (int i = 0; i < 2; ++i) sum |= start[i];  // crash: pointer_index INDEX; crash: pointer_index NULL
  if (sum) pub.publish(sum);
}
EXPLORE(pointer_index, Values, FIELD(data))  // also: handled, ignored

void run_front(Publisher &pub, const Values &msg) {
  pub.publish(msg.data.front());  // crash: front EMPTY
}
EXPLORE(front, Values, FIELD(data))  // also: handled

void run_back_of_text(Publisher &pub, const Text &msg) {
  if (msg.data.back() == '/') pub.publish(1);  // crash: back_of_text EMPTY
}
EXPLORE(back_of_text, Text, FIELD(data))  // also: handled, ignored

void run_pop(Publisher &pub, const Values &msg) {
  std::vector<int32_t> copy = msg.data;
  copy.pop_back();  // crash: pop EMPTY
  pub.publish(copy.size());
}
EXPLORE(pop, Values, FIELD(data))  // also: handled

void run_modulo(Publisher &pub, const Numbers &msg) {
  pub.publish(100 % msg.b);  // crash: modulo DIVISION
}
EXPLORE(modulo, Numbers, FIELD(b))  // also: handled

void run_quotient(Publisher &pub, const Numbers &msg) {
  if (msg.b == 0) return;
  pub.publish(msg.a / msg.b);  // crash: quotient OVERFLOW
}
EXPLORE(quotient, Numbers, FIELD(a); FIELD(b))  // also: handled, ignored

void run_null(Publisher &pub, const Numbers &msg) {
  static int value = 3;
  int *place = msg.flag ? &value : nullptr;
  *place = msg.a;  // crash: null NULL
  pub.publish(*place);
}
EXPLORE(null, Numbers, FIELD(flag); FIELD(a))  // also: handled

void run_null_shared(Publisher &pub, const Numbers &msg) {
  std::shared_ptr<int> held;
  if (msg.a > 5) held = std::make_shared<int>(msg.a);
  pub.publish(*held);  // crash: null_shared NULL
}
EXPLORE(null_shared, Numbers, FIELD(a))  // also: handled

void run_null_unique(Publisher &pub, const Numbers &msg) {
  std::unique_ptr<Numbers> held;
  if (!msg.flag) held.reset(new Numbers(msg));
  pub.publish(held->a);  // crash: null_unique NULL
}
EXPLORE(null_unique, Numbers, FIELD(flag))  // also: handled

void run_dangling(Publisher &pub, const Values &msg) {
  std::vector<int32_t> values(1, 7);
  const int32_t &first = values[0];
  for (int32_t each : msg.data) values.push_back(each);
  pub.publish(first);  // crash: dangling DANGLING
}
EXPLORE(dangling, Values, FIELD(data))  // also: handled

void run_freed(Publisher &pub, const Numbers &msg) {
  int *block = new int(3);
  if (msg.a == 42) delete block;
  volatile int kept = *block;  // crash: freed DANGLING
  pub.publish(kept);
}
EXPLORE(freed, Numbers, FIELD(a))  // also: handled

void run_float_to_integer(Publisher &pub, const Numbers &msg) {
  if (msg.x < 0 || msg.x > 1e6) return;
  pub.publish(static_cast<uint16_t>(msg.x));  // crash: float_to_integer FLOAT_TO_INTEGER
}
EXPLORE(float_to_integer, Numbers, FIELD(x))  // also: handled, ignored

void run_not_a_number(Publisher &pub, const Numbers &msg) {
  if (msg.f < 0 || msg.f > 100) return;
  pub.publish(static_cast<int>(msg.f));  // crash: not_a_number FLOAT_TO_INTEGER
}
EXPLORE(not_a_number, Numbers, FIELD(f))  // also: handled, ignored

void run_sum(Publisher &pub, const Numbers &msg) {
  pub.publish(msg.a + msg.b);  // crash: sum OVERFLOW
}
EXPLORE(sum, Numbers, FIELD(a); FIELD(b))  // also: handled

void run_product(Publisher &pub, const Numbers &msg) {
  int32_t microseconds = msg.a * 1000000;  // crash: product OVERFLOW
  pub.publish(microseconds);
}
EXPLORE(product, Numbers, FIELD(a))  // also: handled

void run_negation(Publisher &pub, const Numbers &msg) {
  pub.publish(-msg.wide);  // crash: negation OVERFLOW
}
EXPLORE(negation, Numbers, FIELD(wide))  // also: handled

void run_shift(Publisher &pub, const Numbers &msg) {
  pub.publish(1u << msg.small);  // crash: shift SHIFT
}
EXPLORE(shift, Numbers, FIELD(small))  // also: handled

void run_stoi(Publisher &pub, const Text &msg) {
  pub.publish(std::stoi(msg.data));  // crash: stoi EXCEPTION
}
EXPLORE(stoi, Text, FIELD(data))  // also: handled

void run_stod(Publisher &pub, const Text &msg) {
  pub.publish(std::stod(msg.data));  // crash: stod EXCEPTION
}
EXPLORE(stod, Text, FIELD(data))  // also: handled

void run_at(Publisher &pub, const Numbers &msg) {
  std::array<int, 3> table{1, 2, 3};
  pub.publish(table.at(msg.small));  // crash: at EXCEPTION
}
EXPLORE(at, Numbers, FIELD(small))  // also: handled

void run_map_at(Publisher &pub, const Text &msg) {
  static const std::map<std::string, int> codes{{"left", 1}, {"right", 2}};
  pub.publish(codes.at(msg.data));  // crash: map_at EXCEPTION
}
EXPLORE(map_at, Text, FIELD(data))  // also: handled

void run_substr(Publisher &pub, const Text &msg) {
  pub.publish(msg.data.substr(3));  // crash: substr EXCEPTION
}
EXPLORE(substr, Text, FIELD(data))  // also: handled

void run_optional(Publisher &pub, const Numbers &msg) {
  std::optional<int> value;
  if (msg.a > 0) value = msg.a;
  pub.publish(*value);  // crash: optional EMPTY
}
EXPLORE(optional, Numbers, FIELD(a))  // also: handled

void run_optional_value(Publisher &pub, const Numbers &msg) {
  std::optional<int> value;
  if (msg.a > 0) value = msg.a;
  pub.publish(value.value());  // crash: optional_value EXCEPTION
}
EXPLORE(optional_value, Numbers, FIELD(a))  // also: handled

void run_variant(Publisher &pub, const Numbers &msg) {
  std::variant<int, std::string> value = 1;
  if (msg.flag) value = std::string("on");
  pub.publish(std::get<int>(value));  // crash: variant EXCEPTION
}
EXPLORE(variant, Numbers, FIELD(flag))  // also: handled

void run_deque_front(Publisher &pub, const Values &msg) {
  std::deque<int> queue(msg.data.begin(), msg.data.end());
  pub.publish(queue.front());  // crash: deque_front EMPTY
}
EXPLORE(deque_front, Values, FIELD(data))  // also: handled

void run_endless_float(Publisher &pub, const Numbers &msg) {
  double angle = msg.x;
  while (angle > M_PI) angle -= 2 * M_PI;  // crash: endless_float ENDLESS
  pub.publish(angle);
}
EXPLORE(endless_float, Numbers, FIELD(x))  // also: handled, unknown

void run_endless_state(Publisher &pub, const Numbers &msg) {
  volatile int left = 1;
  while (left != 0) {
    if (msg.a != 7) left = 0;  // crash: endless_state ENDLESS
  }
  pub.publish(left);
}
EXPLORE(endless_state, Numbers, FIELD(a))  // also: handled

int pick(int number) {  // crash: no_value UNREACHABLE
  if (number > 0) return 1;
  if (number < 0) return -1;
}
void run_no_value(Publisher &pub, const Numbers &msg) { pub.publish(pick(msg.a)); }
EXPLORE(no_value, Numbers, FIELD(a))  // also: handled

void run_length(Publisher &pub, const Numbers &msg) {
  std::vector<double> buffer(msg.a > 100 ? 100 : msg.a);  // crash: length EXCEPTION
  pub.publish(buffer.size());
}
EXPLORE(length, Numbers, FIELD(a))  // also: handled

void run_abort(Publisher &pub, const Numbers &msg) {
  if (msg.small == 255) std::abort();  // crash: abort_ ABORT
  pub.publish(msg.small);
}
void run_abort_(Publisher &pub, const Numbers &msg) { run_abort(pub, msg); }
EXPLORE(abort_, Numbers, FIELD(small))  // also: handled

void run_sizes(Publisher &pub, const Values &msg) {
  double sum = 0;
  for (size_t i = 0; i < msg.data.size(); ++i) sum += msg.data[i] * msg.weights[i];  // crash: sizes INDEX
  pub.publish(sum);
}
EXPLORE(sizes, Values, FIELD(data); FIELD(weights))  // also: handled

void run_copied(Publisher &pub, const Text &msg) {
  char buffer[5];
  std::memcpy(buffer, msg.data.c_str(), msg.data.size());  // crash: copied INDEX
  pub.publish(buffer[0]);
}
EXPLORE(copied, Text, FIELD(data))  // also: handled
