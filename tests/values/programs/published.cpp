// What is sent: constants, clamps, conversions, sizes.
#include "kit.h"

struct Joy { double axis; bool button; int32_t number; uint8_t small; };

void run_clamped(Publisher &pub, const Joy &msg) {
  double speed = msg.axis * 0.26;
  if (speed > 0.22) speed = 0.22;
  else if (speed < -0.22) speed = -0.22;
  pub.publish(speed);
}
EXPLORE(clamped, Joy, FIELD(axis))  // also: handled

void run_constants(Publisher &pub, const Joy &msg) {
  uint8_t color = msg.button ? 3 : 1;
  pub.publish(color);
}
EXPLORE(constants, Joy, FIELD(button))  // also: handled

void run_guarded(Publisher &pub, const Joy &msg) {
  if (msg.number < 10 || msg.number > 20) return;
  pub.publish(msg.number * 2);
}
EXPLORE(guarded, Joy, FIELD(number))  // also: handled, ignored

void run_converted(Publisher &pub, const Joy &msg) {
  pub.publish(static_cast<double>(msg.small) / 4.0);
}
EXPLORE(converted, Joy, FIELD(small))  // also: handled

void run_passed(Publisher &pub, const Joy &msg) {
  if (msg.number < 10 || msg.number > 20) return;
  pub.publish(msg.number);
}
EXPLORE(passed, Joy, FIELD(number))  // also: handled, ignored

void run_passed_in_part(Publisher &pub, const Joy &msg) {
  if (msg.number < 10 || msg.number > 20) return;
  pub.publish(msg.number > 15 ? msg.number : 15);
}
EXPLORE(passed_in_part, Joy, FIELD(number))  // also: handled, ignored
