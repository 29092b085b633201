// A small facade and fillers for the programs of this folder: what a generated harness does, by hand.
#pragma once
#include "../../../impact/values/harness/runtime/rosimpact_values.h"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#ifndef TEXT_BOUND
#define TEXT_BOUND 8
#endif
#ifndef ARRAY_BOUND
#define ARRAY_BOUND 3
#endif

#define LOG_WARN(...) ri_log("warn")

// A number is sent as such; of other things, that they were sent.
struct Publisher {
  const char *name;
  template <class M> void publish(const M &message) const {
    ri_effect("publish", name);
    if constexpr (std::is_floating_point_v<M>) {
      ri_sent_begin(name);
      ri_sent_float64("data", message);
      ri_sent_end();
    } else if constexpr (std::is_integral_v<M>) {
      ri_sent_begin(name);
      ri_sent_integer("data", 8 * sizeof(M), std::is_signed_v<M>, message);
      ri_sent_end();
    }
  }
};

inline void fill(const char *name, uint8_t &value) { value = ri_integer(name, 8, 0); }
inline void fill(const char *name, int8_t &value) { value = ri_integer(name, 8, 1); }
inline void fill(const char *name, uint16_t &value) { value = ri_integer(name, 16, 0); }
inline void fill(const char *name, int16_t &value) { value = ri_integer(name, 16, 1); }
inline void fill(const char *name, uint32_t &value) { value = ri_integer(name, 32, 0); }
inline void fill(const char *name, int32_t &value) { value = ri_integer(name, 32, 1); }
inline void fill(const char *name, int64_t &value) { value = ri_integer(name, 64, 1); }
inline void fill(const char *name, uint64_t &value) { value = ri_integer(name, 64, 0); }
inline void fill(const char *name, bool &value) { value = ri_boolean(name) != 0; }
inline void fill(const char *name, double &value) { value = ri_float64(name); }
inline void fill(const char *name, float &value) { value = ri_float32(name); }

#ifdef RI_SYMBOLIC
// The layouts of libstdc++: no fork for each size.
inline void fill(const char *name, std::string &value) {
  struct Layout { char *start; size_t size; size_t capacity; size_t rest; };
  uint64_t size = ri_size(name, TEXT_BOUND);
  char *start = static_cast<char *>(::operator new(TEXT_BOUND + 1));
  ri_characters(name, start, TEXT_BOUND);
  auto *layout = reinterpret_cast<Layout *>(&value);
  layout->start = start;
  layout->size = size;
  layout->capacity = TEXT_BOUND;
}
template <class T> void fill(const char *name, std::vector<T> &value) {
  struct Layout { T *start; T *end; T *room; };
  uint64_t size = ri_size(name, ARRAY_BOUND);
  T *start = static_cast<T *>(::operator new(ARRAY_BOUND * sizeof(T)));
  ri_enter(name);
  for (uint64_t i = 0; i < ARRAY_BOUND; ++i) {
    ri_enter_index(i);
    new (start + i) T();
    fill("", start[i]);
    ri_leave();
  }
  ri_leave();
  ri_resize(start, size * sizeof(T));
  auto *layout = reinterpret_cast<Layout *>(&value);
  layout->start = start;
  layout->end = start + size;
  layout->room = start + size;
}
#else
inline void fill(const char *name, std::string &value) {
  uint64_t size = ri_size(name, TEXT_BOUND);
  char bytes[TEXT_BOUND + 1];
  ri_characters(name, bytes, TEXT_BOUND);
  value.assign(bytes, size);
}
template <class T> void fill(const char *name, std::vector<T> &value) {
  uint64_t size = ri_size(name, ARRAY_BOUND);
  ri_enter(name);
  for (uint64_t i = 0; i < size; ++i) {
    ri_enter_index(i);
    T element{};
    fill("", element);
    value.push_back(element);
    ri_leave();
  }
  ri_leave();
}
#endif

// HARNESS(entry, Message, Node, filling, call): a function `entry` that fills `message` and runs the callback of `node`.
#define HARNESS(entry, Message, Node, filling, call)                                                                   \
  extern "C" void entry() {                                                                                            \
    alignas(Message) static unsigned char message_bytes[sizeof(Message)];                                              \
    alignas(Node) static unsigned char node_bytes[sizeof(Node)];                                                       \
    Message &message = *new (message_bytes) Message();                                                                 \
    Node &node = *new (node_bytes) Node();                                                                             \
    ri_enter("msg");                                                                                                   \
    filling;                                                                                                           \
    ri_leave();                                                                                                        \
    call;                                                                                                              \
  }
#define FIELD(field) fill(#field, message.field)
// EXPLORE(entry, Type, filling): an entry for a function `run_<entry>(publisher, message)`.
#define EXPLORE(entry, Type, filling)                                                                                  \
  extern "C" void entry() {                                                                                            \
    static Publisher pub{"pub"};                                                                                       \
    alignas(Type) static unsigned char message_bytes[sizeof(Type)];                                                    \
    Type &message = *new (message_bytes) Type();                                                                       \
    ri_enter("msg");                                                                                                   \
    filling;                                                                                                           \
    ri_leave();                                                                                                        \
    run_##entry(pub, message);                                                                                            \
  }
#define MEMBER(member) ri_member(#member, &node.member, sizeof(node.member))
