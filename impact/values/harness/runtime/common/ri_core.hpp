// What facades, messages and harnesses share: inputs and sent values by type, callbacks that were given to the
// framework, and what stands for anything that is not known.
#pragma once
#include <iosfwd>
#ifdef RI_SYMBOLIC
// Stays a call, which the executor knows: inlined, these ask a stream of the library for what nobody has written there.
namespace std {
template <class C, class T> __attribute__((noinline)) basic_ostream<C, T> &endl(basic_ostream<C, T> &);
template <class C, class T> __attribute__((noinline)) basic_ostream<C, T> &ends(basic_ostream<C, T> &);
template <class C, class T> __attribute__((noinline)) basic_ostream<C, T> &flush(basic_ostream<C, T> &);
}  // namespace std
#endif
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <ostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "rosimpact_values.h"
#ifndef RI_TEXT
#define RI_TEXT 8
#endif
#ifndef RI_ARRAY
#define RI_ARRAY 3
#endif

namespace ri {

// 0 while main and constructors run, 1 in the callback.
inline int phase = 0;
// Whether what is explored is main or a constructor itself; then loops that ask whether ROS is up have two rounds.
inline bool is_main = false;

inline void begin() noexcept { phase = 1; ri_begin(); }
inline void effect(const char *kind, const char *name) noexcept { if (phase) ri_effect(kind, name); }
inline void log(const char *level) noexcept { if (phase) ri_log(level); }
template <class... A> inline void log_all(const char *level, A &&...) noexcept { log(level); }
inline void unknown(const char *what) noexcept { if (phase) ri_unknown(what); }
// What is done by code that is not here. What it is handed may be changed by it.
template <class T> void touch(T &value);
template <class... A> void foreign(const char *what, A &&...a) noexcept {
  if (phase) ri_foreign(what);
#ifdef RI_SYMBOLIC
  (void)what; (touch(a), ...);
#endif
}

// What stands for parts of the sources that do not compile. Where one lies on the way to the callback, nothing is known
// of what it would have set. The second kind stands where a value would have been given.
inline int was_cut = 0;
inline void cut(const char *what) noexcept { if (!phase) was_cut = 1; ri_cut(what); }
[[noreturn]] inline void cut_end(const char *what) noexcept { ri_unknown(what); ri_end(); }

// Swallows what is logged.
struct Stream {
  template <class T> const Stream &operator<<(const T &) const { return *this; }
  const Stream &operator<<(std::ostream &(*)(std::ostream &)) const { return *this; }
  const Stream &operator<<(std::ios_base &(*)(std::ios_base &)) const { return *this; }
};

// ---- Anything: what a header that is not here declares. Its use is noted; what it gives is any value.

struct Anything;
template <class T> T &make_something();
// A number that nothing is known of.
struct Number {
  operator int() const { foreign("a number of a header that is not here"); return make_something<int>(); }
  template <class A> Number &operator=(const A &) { foreign("a number of a header that is not here"); return *this; }
};
template <class T> struct is_initializer_list : std::false_type {};
template <class T> struct is_initializer_list<std::initializer_list<T>> : std::true_type {};

struct Anything {
  const char *name = "something of a header that is not here";
  Anything() {}
  Anything(const Anything &) = default;
  Anything(Anything &&) = default;
  template <class A, class... B, class = std::enable_if_t<!std::is_base_of<Anything, std::decay_t<A>>::value>>
  Anything(A &&, B &&...) {}
  template <class A, class... B, class = std::enable_if_t<std::is_base_of<Anything, std::decay_t<A>>::value &&
                                                          (sizeof...(B) > 0)>, class = void>
  Anything(A &&, B &&...) {}
  Anything &operator=(const Anything &) { foreign(name); return *this; }
  template <class A> Anything &operator=(A &&) { foreign(name); return *this; }
  template <class... A> Anything &operator()(A &&...a) const { foreign(name, a...); return make_something<Anything>(); }
  template <class A> Anything &operator[](A &&) const { foreign(name); return make_something<Anything>(); }
  Anything *operator->() const { foreign(name); return const_cast<Anything *>(this); }
  Anything &operator*() const { foreign(name); return const_cast<Anything &>(*this); }
  Anything &operator++() { foreign(name); return *this; }
  Anything operator++(int) { foreign(name); return *this; }
  Anything operator-() const { foreign(name); return *this; }
  Anything *begin() const { foreign(name); return const_cast<Anything *>(this); }
  Anything *end() const { return const_cast<Anything *>(this); }
  // Not to what would make an assignment to a text ambiguous.
  template <class T, class = std::enable_if_t<!std::is_base_of<Anything, T>::value && !std::is_reference<T>::value &&
                                              !std::is_same<T, char>::value && !std::is_same<T, const char *>::value &&
                                              !is_initializer_list<T>::value>>
  operator T() const { foreign(name); return make_something<std::remove_cv_t<T>>(); }
#ifdef RI_EXTRA_ri_Anything
  RI_EXTRA_ri_Anything
#endif
};

// What a class that stands for one of a header that is not here consists of.
#define RI_STAND_IN(X)                                                                                      \
  using ri::Anything::Anything;                                                                             \
  X() {}                                                                                                    \
  X(const X &) = default;                                                                                   \
  X(X &&) = default;                                                                                        \
  X &operator=(const X &) = default;                                                                        \
  template <class RiA, class = std::enable_if_t<std::is_base_of<ri::Anything, std::decay_t<RiA>>::value &&  \
                                                !std::is_base_of<X, std::decay_t<RiA>>::value>>             \
  X(RiA &&) {}                                                                                              \
  using ri::Anything::operator=;

template <class T> T &make_something() {
  alignas(T) static unsigned char place[sizeof(T)];
  if constexpr (std::is_arithmetic<T>::value || std::is_pointer<T>::value || std::is_enum<T>::value) {
    ri_forget(place, sizeof(T));
    return *reinterpret_cast<T *>(place);
  }
  else if constexpr (std::is_default_constructible<T>::value) {
    T &made = *new (place) T();
#ifdef RI_SYMBOLIC
    touch(made);
#endif
    return made;
  }
  else
    return *reinterpret_cast<T *>(place);
}

#define RI_OPERATOR(op)                                                                                     \
  template <class A, class B,                                                                               \
            class = std::enable_if_t<std::is_base_of<Anything, std::decay_t<A>>::value ||                   \
                                     std::is_base_of<Anything, std::decay_t<B>>::value>>                    \
  Anything operator op(A &&, B &&) { foreign("an operator of what a header that is not here declares"); return {}; }
RI_OPERATOR(+) RI_OPERATOR(-) RI_OPERATOR(*) RI_OPERATOR(/) RI_OPERATOR(%) RI_OPERATOR(&) RI_OPERATOR(|)
#undef RI_OPERATOR
#define RI_OPERATOR(op)                                                                                     \
  template <class A, class B,                                                                               \
            class = std::enable_if_t<std::is_base_of<Anything, std::decay_t<A>>::value ||                   \
                                     std::is_base_of<Anything, std::decay_t<B>>::value>>                    \
  Anything operator op(A &&a, B &&b) { foreign("an operator of what a header that is not here declares", a, b); return {}; }
RI_OPERATOR(<<) RI_OPERATOR(>>) RI_OPERATOR(+=) RI_OPERATOR(-=) RI_OPERATOR(*=) RI_OPERATOR(/=) RI_OPERATOR(|=)
#undef RI_OPERATOR
#define RI_COMPARES(op)                                                                                     \
  template <class A, class B,                                                                               \
            class = std::enable_if_t<std::is_base_of<Anything, std::decay_t<A>>::value ||                   \
                                     std::is_base_of<Anything, std::decay_t<B>>::value>>                    \
  bool operator op(A &&, B &&) { foreign("a comparison of what a header that is not here declares"); return make_something<bool>(); }
RI_COMPARES(==) RI_COMPARES(!=) RI_COMPARES(<) RI_COMPARES(>) RI_COMPARES(<=) RI_COMPARES(>=)
#undef RI_COMPARES

// ---- What types there are.

template <class T, class = void> struct is_message : std::false_type {};
template <class T> struct is_message<T, std::void_t<typename T::ri_is_message>> : std::true_type {};
// What is known of in part: it has ri_lose() to forget that, and ri_fill() for what another callback may have left.
template <class T, class = void> struct can_lose : std::false_type {};
template <class T> struct can_lose<T, std::void_t<decltype(std::declval<T &>().ri_lose())>> : std::true_type {};
template <class T> struct is_vector : std::false_type {};
template <class T, class A> struct is_vector<std::vector<T, A>> : std::true_type {};
template <class T, class = void> struct is_fixed : std::false_type {};
template <class T> struct is_fixed<T, std::void_t<decltype(std::tuple_size<T>::value), typename T::value_type,
                                                  decltype(std::declval<T &>()[0])>> : std::true_type {};
template <class T, class = void> struct is_bounded : std::false_type {};
template <class T> struct is_bounded<T, std::void_t<decltype(T::ri_bound)>> : std::true_type {};

// ---- Inputs.

template <class T> void fill(T &value, const char *name);

#ifdef RI_SYMBOLIC
// By the layout of libstdc++, so that a size may be symbolic without a fork.
struct TextLayout { char *start; uint64_t size; uint64_t capacity; uint64_t rest; };
inline void fill_text(std::string &value, const char *name) {
  uint64_t size = ri_size(name, RI_TEXT);
  char *bytes = static_cast<char *>(::operator new(RI_TEXT + 1));
  ri_characters(name, bytes, RI_TEXT);
  auto *layout = reinterpret_cast<TextLayout *>(&value);
  layout->start = bytes; layout->size = size; layout->capacity = size;
  ri_resize(bytes, size + 1);
}
template <class T> struct ArrayLayout { T *start, *end, *capacity; };
template <class T> void fill_array(std::vector<T> &value, const char *name, uint64_t most) {
  uint64_t size = ri_size(name, most);
  T *start = static_cast<T *>(::operator new(most * sizeof(T)));
  ri_enter(name);
  for (uint64_t at = 0; at < most; ++at) { new (start + at) T(); ri_enter_index(at); fill(start[at], ""); ri_leave(); }
  ri_leave();
  auto *layout = reinterpret_cast<ArrayLayout<T> *>(&value);
  layout->start = start; layout->end = start + size; layout->capacity = start + size;
  ri_resize(start, size * sizeof(T));
}
#else
inline void fill_text(std::string &value, const char *name) {
  uint64_t size = ri_size(name, RI_TEXT);
  char bytes[RI_TEXT + 1];
  ri_characters(name, bytes, RI_TEXT);
  value.assign(bytes, size);
}
template <class T> void fill_array(std::vector<T> &value, const char *name, uint64_t most) {
  uint64_t size = ri_size(name, most);
  value.clear();
  value.reserve(size);
  ri_enter(name);
  for (uint64_t at = 0; at < size; ++at) {
    value.emplace_back();
    ri_enter_index(at); fill(value.back(), ""); ri_leave();
  }
  ri_leave();
}
#endif
template <class A> void fill_bits(std::vector<bool, A> &value, const char *name, uint64_t most) {
  uint64_t size = ri_size(name, most);
  value.assign(size, false);
  ri_enter(name);
  for (uint64_t at = 0; at < size; ++at) {
    ri_enter_index(at); value[at] = ri_boolean("") != 0; ri_leave();
  }
  ri_leave();
}

struct Filler { template <class T> void operator()(const char *name, T &value) { fill(value, name); } };

template <class T> void fill(T &value, const char *name) {
  if constexpr (std::is_same<T, bool>::value) value = ri_boolean(name) != 0;
  else if constexpr (std::is_same<T, double>::value) value = ri_float64(name);
  else if constexpr (std::is_same<T, float>::value) value = ri_float32(name);
  else if constexpr (std::is_integral<T>::value)
    value = static_cast<T>(ri_integer(name, 8 * sizeof(T), std::is_signed<T>::value));
  else if constexpr (std::is_enum<T>::value)
    value = static_cast<T>(ri_integer(name, 8 * sizeof(T), std::is_signed<std::underlying_type_t<T>>::value));
  else if constexpr (std::is_same<T, std::string>::value) fill_text(value, name);
  else if constexpr (std::is_same<T, std::u16string>::value) {
    uint64_t size = ri_size(name, RI_TEXT);
    value.assign(size, u' ');
    ri_enter(name);
    for (uint64_t at = 0; at < size; ++at) { ri_enter_index(at); value[at] = ri_integer("", 16, 0); ri_leave(); }
    ri_leave();
  }
  else if constexpr (is_message<T>::value) {
    if (*name) ri_enter(name);
    Filler filler;
    T::ri_each(filler, value);
    if (*name) ri_leave();
  }
  else if constexpr (is_bounded<T>::value) {
    uint64_t most = T::ri_bound < RI_ARRAY ? T::ri_bound : RI_ARRAY;
    if constexpr (std::is_same<typename T::value_type, bool>::value) fill_bits(value.ri_base(), name, most);
    else fill_array(value.ri_base(), name, most);
  }
  else if constexpr (is_vector<T>::value) {
    if constexpr (std::is_same<typename T::value_type, bool>::value) fill_bits(value, name, RI_ARRAY);
    else if constexpr (std::is_same<T, std::vector<typename T::value_type>>::value) fill_array(value, name, RI_ARRAY);
    else unknown(name);
  }
  else if constexpr (is_fixed<T>::value) {
    ri_enter(name);
    for (uint64_t at = 0; at < std::tuple_size<T>::value; ++at) { ri_enter_index(at); fill(value[at], ""); ri_leave(); }
    ri_leave();
  }
  else if constexpr (std::is_array<T>::value) {
    ri_enter(name);
    for (uint64_t at = 0; at < std::extent<T>::value; ++at) { ri_enter_index(at); fill(value[at], ""); ri_leave(); }
    ri_leave();
  }
}

template <class T> inline constexpr bool is_scalar_state =
    std::is_arithmetic<T>::value || std::is_enum<T>::value || std::is_same<T, std::string>::value;

// A member or a global variable as it may be when the callback is called.
template <class T> void fill_state(T &value, const char *name) {
  if constexpr (std::is_const<T>::value) { (void)value; }
  else if constexpr (is_scalar_state<T>) fill(value, name);
  else if constexpr (can_lose<T>::value) { ri_enter(name); value.ri_fill(); ri_leave(); }
  else if constexpr (std::is_array<T>::value || is_fixed<T>::value) {
    if constexpr (std::is_arithmetic<std::decay_t<decltype(value[0])>>::value &&
                  sizeof(T) / sizeof(value[0]) <= 16) fill(value, name);
  }
}

// The same for what is only counted up from where it is, or set to numbers from `least` on.
template <class T> void fill_rising(T &value, const char *name, int least) {
  if constexpr (std::is_integral<T>::value && !std::is_same<T, bool>::value && !std::is_const<T>::value) {
    const T before = value;
    fill(value, name);
    if constexpr (std::is_signed<T>::value) ri_assume(value >= before || value >= static_cast<int64_t>(least));
    else ri_assume(value >= before || least <= 0 || value >= static_cast<uint64_t>(least));
  }
  else fill_state(value, name);
}

// ---- What is sent.

template <class T> void send(const T &value, const char *name);
struct Sender { template <class T> void operator()(const char *name, const T &value) { send(value, name); } };

template <class T> void send(const T &value, const char *name) {
  if constexpr (std::is_same<T, bool>::value) ri_sent_boolean(name, value);
  else if constexpr (std::is_same<T, double>::value) ri_sent_float64(name, value);
  else if constexpr (std::is_same<T, float>::value) ri_sent_float32(name, value);
  else if constexpr (std::is_integral<T>::value)
    ri_sent_integer(name, 8 * sizeof(T), std::is_signed<T>::value, static_cast<uint64_t>(value));
  else if constexpr (std::is_same<T, std::string>::value) ri_sent_characters(name, value.data(), value.size());
  else if constexpr (is_message<T>::value) {
    if (*name) ri_enter(name);
    Sender sender;
    T::ri_each(sender, value);
    if (*name) ri_leave();
  }
  else if constexpr (is_vector<T>::value || is_bounded<T>::value) {
    ri_sent_size(name, value.size());
#ifndef RI_SYMBOLIC
    ri_enter(name);
    for (size_t at = 0; at < value.size() && at < RI_ARRAY; ++at) {
      ri_enter_index(at);
      send(static_cast<typename T::value_type>(value[at]), "");
      ri_leave();
    }
    ri_leave();
#endif
  }
  else if constexpr (is_fixed<T>::value) {
    ri_enter(name);
    for (uint64_t at = 0; at < std::tuple_size<T>::value; ++at) { ri_enter_index(at); send(value[at], ""); ri_leave(); }
    ri_leave();
  }
}

template <class M> void publish(const char *kind, const char *name, const M &message) {
  if (!phase) return;
  ri_effect(kind, name);
  if constexpr (is_message<M>::value) {
    ri_sent_begin(name);
    Sender sender;
    M::ri_each(sender, message);
    ri_sent_end();
  }
}

// ---- Names of publishers and the like: the topic, until the harness gives the member's name.

struct Named {
  const char *ri_name = "";
  void ri_set_name(const char *name) { ri_name = name; }
  void ri_keep_name(const std::string &name) {
    char *copy = static_cast<char *>(::operator new(name.size() + 1));
    memcpy(copy, name.data(), name.size());
    copy[name.size()] = 0;
    ri_name = copy;
  }
};
template <class T, class = void> struct has_name : std::false_type {};
template <class T> struct has_name<T, std::void_t<decltype(std::declval<T &>().ri_set_name(""))>> : std::true_type {};
template <class T> struct is_pointer_like : std::false_type {};
template <class T> struct is_pointer_like<std::shared_ptr<T>> : std::true_type {};
template <class T, class D> struct is_pointer_like<std::unique_ptr<T, D>> : std::true_type {};

// Gives a member's name to the publisher, client or broadcaster in it. make: where it is a pointer to none, one is made.
template <class T> void name_member(T &value, const char *name, bool make) {
  if constexpr (has_name<T>::value) value.ri_set_name(name);
  else if constexpr (is_pointer_like<T>::value) {
    using Inner = typename T::element_type;
    if constexpr (has_name<Inner>::value && !std::is_const<Inner>::value) {
      if constexpr (std::is_default_constructible<Inner>::value) { if (make && !value) value.reset(new Inner()); }
      if (value) value->ri_set_name(name);
    }
  }
}

// A member or variable that nothing is known of. Handles of the framework stay.
template <class T> struct is_lock;
template <class T> inline constexpr bool can_fill = is_message<T>::value || std::is_same<T, std::string>::value;
template <class T, class A> inline constexpr bool can_fill<std::vector<T, A>> =
    !std::is_same<T, bool>::value && (can_fill<T> || std::is_arithmetic<T>::value);
inline uint64_t touched = 0;
template <class T> void fill_foreign(T &value) {
  ri_enter("~foreign"); ri_enter_index(touched++); fill(value, ""); ri_leave(); ri_leave();
}
template <class T> void forget(T &value) {
  if constexpr (can_lose<T>::value) value.ri_lose();
  else if constexpr (std::is_reference<T>::value || has_name<T>::value || is_lock<std::remove_cv_t<T>>::value ||
                std::is_base_of<Anything, T>::value) (void)value;
  else if constexpr (is_pointer_like<std::remove_cv_t<T>>::value) {
    // The pointer alone: an object that is shared without a count.
    if constexpr (!has_name<std::remove_cv_t<typename T::element_type>>::value) ri_forget((const void *)&value, sizeof(void *));
  }
#ifdef RI_SYMBOLIC
  else if constexpr (can_fill<T>) fill_foreign(value);
#endif
  else ri_forget((const void *)&value, sizeof(T));
}
// A member that cannot be watched: what the callback does to it is not seen.
inline void lose_member() noexcept { ri_foreign("a member that cannot be watched"); }

// What code that is not here was handed: messages and texts are filled anew, the rest is forgotten.
template <class T> void touch(T &value) {
  if constexpr (can_lose<T>::value) value.ri_lose();
  else if constexpr (std::is_const<T>::value || std::is_function<T>::value || has_name<T>::value || is_lock<T>::value ||
                std::is_base_of<Anything, T>::value || std::is_empty<T>::value) (void)value;
  else if constexpr (std::is_pointer<T>::value) {
    using Inner = std::remove_pointer_t<T>;
    if constexpr (!std::is_const<Inner>::value && !std::is_function<Inner>::value)
      if (phase && value) ri_forget((const void *)value, 0);
  }
  else if constexpr (is_pointer_like<T>::value) {
    using Inner = typename T::element_type;
    if constexpr (!std::is_const<Inner>::value && is_message<Inner>::value) { if (value) touch(*value); }
    else if constexpr (!std::is_const<Inner>::value && !has_name<Inner>::value)
      if (phase && value) ri_forget((const void *)value.get(), 0);
  }
  else if constexpr (can_fill<T>) fill_foreign(value);
  else ri_forget((const void *)&value, sizeof(T));
}
template <class T> void forget_cut(T &value) { if (was_cut) forget(value); }

// Watches a member. Handles of the framework and locks are no state.
template <class T> struct is_lock : std::false_type {};
template <> struct is_lock<std::mutex> : std::true_type {};
template <> struct is_lock<std::recursive_mutex> : std::true_type {};
template <class T> void watch_member(const T &value, const char *name) {
  if constexpr (has_name<T>::value || is_lock<T>::value || std::is_base_of<Anything, T>::value) { (void)value; (void)name; }
  else ri_member(name, static_cast<const void *>(&value), sizeof(T));
}

// ---- Callbacks that were given to the framework.

struct Given {
  const char *kind;   // subscriber service timer action parameter response
  const char *file;
  int line;
  void (*run)(void *);
  void *closure;
  Given *next;
};
inline Given *given = nullptr;
inline Given *last_given = nullptr;
// Which one the harness waits for.
inline const char *wanted_kind = nullptr;
inline const char *wanted_file = nullptr;
inline int wanted_line = 0;
inline int wanted_nth = 0;
// Of several messages that a callback is given, the one that is asked about: it is `msg`, the others `msg2` and so on.
inline int wanted_place = 0;
// The lines of the other calls in that file that give a callback of the kind, ended by 0: what is nearer to one of these
// is not the wanted one.
inline const int *other_lines = nullptr;
// What comes right before it runs: state is made symbolic and watched.
inline void (*prepare)(void *) = nullptr;
inline void *prepare_with = nullptr;

inline bool ends_alike(const char *full, const char *end) {
  size_t one = strlen(full), other = strlen(end);
  if (other > one) return false;
  for (size_t at = 0; at < other; ++at) if (full[one - other + at] != end[at]) return false;
  return true;
}

inline void give(const char *kind, const char *file, int line, void (*run)(void *), void *closure) {
  Given *made = new Given{kind, file, line, run, closure, nullptr};
  if (last_given) last_given->next = made; else given = made;
  last_given = made;
}

// Runs the callback that the harness waits for, if it was given, and ends; does nothing otherwise.
inline void deliver() {
  if (!wanted_kind || phase) return;
  Given *best = nullptr;
  int distance = 12, nth = wanted_nth;
  for (Given *one = given; one; one = one->next) {
    if (strcmp(one->kind, wanted_kind) != 0 || !ends_alike(one->file, wanted_file)) continue;
    int away = one->line > wanted_line ? one->line - wanted_line : wanted_line - one->line;
    bool is_other = false;
    for (const int *each = other_lines; each && *each; ++each)
      if ((one->line > *each ? one->line - *each : *each - one->line) < away) is_other = true;
    if (is_other) continue;
    if (away < distance) { distance = away; best = one; nth = wanted_nth; }
    else if (best && away == distance && best->line == one->line && nth > 0) { --nth; best = one; }
  }
  if (!best) return;
  if (prepare) prepare(prepare_with);
  best->run(best->closure);
  ri_end();
}

// Where nothing can be delivered, this way says nothing of the callback.
inline void deliver_or_drop() { deliver(); ri_assume(0); ri_end(); }

// ---- Messages as callbacks take them.

template <class M> std::shared_ptr<M> make_message(const char *name) {
  auto made = std::make_shared<M>();
  fill(*made, name);
  return made;
}

template <class F> void start(F &&call) {
  begin();
  call();
}

template <class M> struct Event {
  std::shared_ptr<M const> message;
  const std::shared_ptr<M const> &getMessage() const { return message; }
  const std::shared_ptr<M const> &getConstMessage() const { return message; }
  std::string getPublisherName() const { return "publisher"; }
};

struct Info {};

// Whether a callback takes a message in one of these forms.
template <class M, class F> inline constexpr bool takes_message =
    std::is_invocable<F &, const std::shared_ptr<M const> &>::value || std::is_invocable<F &, const M &>::value ||
    std::is_invocable<F &, std::shared_ptr<M>>::value || std::is_invocable<F &, std::unique_ptr<M>>::value ||
    std::is_invocable<F &, M &>::value || std::is_invocable<F &, const Event<M> &>::value || std::is_invocable<F &>::value ||
    std::is_invocable<F &, const std::shared_ptr<M const> &, const Info &>::value ||
    std::is_invocable<F &, const M &, const Info &>::value;

template <class M, class F> void call_with(F &callback, const std::shared_ptr<M> &made, const Info & = {}) {
  using Shared = std::shared_ptr<M>;
  using ConstShared = std::shared_ptr<M const>;
  using Unique = std::unique_ptr<M>;
  if constexpr (std::is_invocable<F &, const ConstShared &>::value) {
    ConstShared given = made; begin(); callback(given);
  }
  else if constexpr (std::is_invocable<F &, const M &>::value) { begin(); callback(static_cast<const M &>(*made)); }
  else if constexpr (std::is_invocable<F &, Shared>::value) { begin(); callback(made); }
  else if constexpr (std::is_invocable<F &, Unique>::value) { Unique own(new M(*made)); begin(); callback(std::move(own)); }
  else if constexpr (std::is_invocable<F &, M &>::value) { begin(); callback(*made); }
  else if constexpr (std::is_invocable<F &, const Event<M> &>::value) {
    Event<M> event{made}; begin(); callback(static_cast<const Event<M> &>(event));
  }
  else if constexpr (std::is_invocable<F &, const ConstShared &, const Info &>::value) {
    ConstShared given = made; begin(); callback(given, Info());
  }
  else if constexpr (std::is_invocable<F &, const M &, const Info &>::value) { begin(); callback(*made, Info()); }
  else if constexpr (std::is_invocable<F &>::value) { begin(); callback(); }
  else { begin(); ri_unknown("a callback that takes its message in a form that is not modelled"); }
}

template <class M, class F> struct Holder {
  F callback;
  static void run(void *self) {
    auto made = make_message<M>("msg");
    call_with<M>(static_cast<Holder *>(self)->callback, made);
  }
};
template <class M, class F> void give_callback(const char *kind, F callback, const char *file, int line) {
  give(kind, file, line, &Holder<M, F>::run, new Holder<M, F>{std::move(callback)});
}
template <class F> struct PlainHolder {
  F callback;
  static void run(void *self) { begin(); static_cast<PlainHolder *>(self)->callback(); }
};
template <class F> void give_plain(const char *kind, F callback, const char *file, int line) {
  give(kind, file, line, &PlainHolder<F>::run, new PlainHolder<F>{std::move(callback)});
}

// ---- Parameters: an input where it is set, else what the code says.

inline bool is_parameter_set(const char *name) {
  ri_enter("~param"); ri_enter(name);
  bool found = ri_boolean("set") != 0;
  ri_leave(); ri_leave();
  return found;
}
template <class T> T get_parameter(const char *name, const T &otherwise) {
  if constexpr (std::is_arithmetic<T>::value) {
    T value{};
    bool found = is_parameter_set(name);
    ri_enter("~param"); fill(value, name); ri_leave();
    return found ? value : otherwise;
  }
  else return otherwise;
}
template <class T> bool find_parameter(const char *name, T &value) {
  bool found = is_parameter_set(name);
  if constexpr (std::is_arithmetic<T>::value || std::is_same<T, std::string>::value) {
    if (found) { ri_enter("~param"); fill(value, name); ri_leave(); }
  }
  return found;
}

// ---- What harnesses make objects of.

template <class T> struct PointedTo { using type = void; };
template <class T> struct PointedTo<std::shared_ptr<T>> { using type = T; };
template <class T> struct WatchedBy { using type = void; };
template <class T> struct WatchedBy<std::weak_ptr<T>> { using type = T; };

template <class T> inline constexpr bool can_give =
    std::is_pointer<T>::value || std::is_default_constructible<T>::value || std::is_constructible<T, std::string>::value ||
    !std::is_void<typename PointedTo<T>::type>::value;

// An argument of a constructor or of a function that subscribes.
template <class T, class = std::enable_if_t<can_give<T>>> T &give_argument() {
  if constexpr (std::is_pointer<T>::value) {
    using Inner = std::remove_cv_t<std::remove_pointer_t<T>>;
    static T made = nullptr;
    if constexpr (std::is_class<Inner>::value && std::is_default_constructible<Inner>::value) made = new Inner();
    return made;
  }
  else if constexpr (std::is_same<T, std::string>::value) { static std::string made = "node"; return made; }
  else if constexpr (!std::is_void<typename WatchedBy<T>::type>::value) {
    static T made = give_argument<std::shared_ptr<typename WatchedBy<T>::type>>(); return made;
  }
  else if constexpr (!std::is_void<typename PointedTo<T>::type>::value) {
    using Inner = std::remove_cv_t<typename PointedTo<T>::type>;
    if constexpr (std::is_constructible<Inner, std::string>::value && !std::is_default_constructible<Inner>::value) {
      static T made = std::make_shared<Inner>(std::string("node")); return made;
    }
    else if constexpr (std::is_default_constructible<Inner>::value) { static T made = std::make_shared<Inner>(); return made; }
    else { static T made; return made; }
  }
  else if constexpr (std::is_default_constructible<T>::value) { static T made{}; return made; }
  else { static T made{std::string("node")}; return made; }
}

template <class B, class N, class... A> void make_base(N *node, A &&...a) {
  if constexpr (std::is_base_of<B, N>::value) new (static_cast<void *>(static_cast<B *>(node))) B(std::forward<A>(a)...);
}
template <class T> void make_member(T &member) {
  if constexpr (std::is_array<T>::value) { for (auto &one : member) make_member(one); }
  else if constexpr (std::is_class<T>::value && std::is_default_constructible<T>::value && !std::is_const<T>::value)
    new (static_cast<void *>(&member)) T();
}
template <class T, class V> void set_member(T &member, const V &value) {
  if constexpr (!std::is_const<T>::value && !std::is_array<T>::value && std::is_assignable<T &, const V &>::value) member = value;
}
template <class E, class F> void run_timer(F &callback) {
  begin();
  if constexpr (std::is_invocable<F &>::value) callback();
  else if constexpr (std::is_invocable<F &, const E &>::value) callback(E());
  else ri_unknown("a timer's callback");
}

inline int asked_now = 0;
inline int64_t last_now = 0;
// Any time, but none before one that was given already.
inline int64_t get_now() {
  ri_enter("~now"); ri_enter_index(asked_now);
  int64_t value = static_cast<int64_t>(ri_integer("", 64, 1));
  ri_leave(); ri_leave();
  if (asked_now++) ri_assume(value >= last_now);
  last_now = value;
  return value;
}

}  // namespace ri
