// Code that is not here: what it may change, and what its results may be.
#include "kit.h"

struct Joy { int32_t number; };

struct Engine { Engine(); int level; };
int measure(const Joy &);
void adjust(int &);

struct Car {
  Publisher *pub;
  Engine engine;
  int speed = 3;
};

// The constructor of a member changes that member, and not what lies before and behind it.
void run_drive(Publisher &pub, const Joy &msg) {
  ri_begin();
  Car car{&pub};
  if (msg.number > car.speed) car.pub->publish(msg.number);
}
EXPLORE(drive, Joy, FIELD(number))  // also: handled, unknown

// What a function gives is any; that it does nothing is not known.
void run_measured(Publisher &pub, const Joy &msg) {
  ri_begin();
  if (measure(msg) > 2) pub.publish(msg.number);
}
EXPLORE(measured, Joy, FIELD(number))  // also: handled, unknown

void run_adjusted(Publisher &pub, const Joy &msg) {
  ri_begin();
  int number = 1;
  adjust(number);
  if (number == msg.number) pub.publish(number);
}
EXPLORE(adjusted, Joy, FIELD(number))  // also: handled, unknown

// A pointer that is not known leads to something, or nowhere, which is no crash for sure.
struct Holder { int *found; };
HARNESS(held, Joy, Holder, FIELD(number), {
  ri_forget(&node, sizeof node);
  ri_begin();
  static Publisher pub{"pub"};
  if (*node.found == message.number) pub.publish(message.number);
})  // also: handled, unknown

// What is called before the callback begins is none of it.
HARNESS(early, Joy, Joy, FIELD(number), {
  adjust(node.number);
  ri_begin();
  static Publisher pub{"pub"};
  if (message.number == 4) pub.publish(message.number);
})  // also: handled, ignored

// Nor is a crash there a verdict.
HARNESS(late, Joy, Joy, FIELD(number), {
  assert(node.number == 1);
  ri_begin();
})  // also: unknown

// Where a part of the code is left out in the callback, the way ends.
HARNESS(left, Joy, Joy, FIELD(number), {
  ri_cut("before");
  ri_begin();
  static Publisher pub{"pub"};
  if (message.number == 4) ri_cut("within");
  if (message.number == 5) ri_foreign("something");
  if (message.number == 6) pub.publish(1);
})  // also: handled, ignored, unknown
