// What ROS 1 code commonly uses of Boost, as the standard library has it.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cctype>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <regex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace boost {
using std::shared_ptr; using std::weak_ptr; using std::make_shared; using std::allocate_shared;
using std::enable_shared_from_this; using std::static_pointer_cast; using std::dynamic_pointer_cast;
using std::const_pointer_cast; using std::unique_ptr; using std::make_unique; using std::array;
using std::function; using std::mem_fn; using std::ref; using std::cref; using std::reference_wrapper;
using std::tuple; using std::make_tuple; using std::tie; using std::get; using std::unordered_map;
using std::unordered_set; using std::begin; using std::end; using std::swap; using std::move; using std::forward;
using std::lock_guard; using std::thread; using std::hash;
using std::atomic; using std::regex; using std::smatch; using std::cmatch; using std::regex_match;
using std::regex_search; using std::regex_replace; using std::addressof;
}  // namespace boost
// As <boost/bind.hpp> declares them.
namespace {
[[maybe_unused]] constexpr std::_Placeholder<1> _1; [[maybe_unused]] constexpr std::_Placeholder<2> _2;
[[maybe_unused]] constexpr std::_Placeholder<3> _3; [[maybe_unused]] constexpr std::_Placeholder<4> _4;
[[maybe_unused]] constexpr std::_Placeholder<5> _5; [[maybe_unused]] constexpr std::_Placeholder<6> _6;
[[maybe_unused]] constexpr std::_Placeholder<7> _7; [[maybe_unused]] constexpr std::_Placeholder<8> _8;
}  // namespace

namespace boost {
using shared_mutex = std::shared_mutex;
using recursive_timed_mutex = std::recursive_timed_mutex;
using timed_mutex = std::timed_mutex;
using condition_variable = std::condition_variable;
using condition_variable_any = std::condition_variable_any;
struct defer_lock_t_ {};
template <class M> struct unique_lock : std::unique_lock<M> { using std::unique_lock<M>::unique_lock; };
template <class M> unique_lock(M &) -> unique_lock<M>;
template <class M> using shared_lock = std::shared_lock<M>;
inline constexpr std::defer_lock_t defer_lock{};
inline constexpr std::try_to_lock_t try_to_lock{};
inline constexpr std::adopt_lock_t adopt_lock{};
template <class T> using scoped_ptr = std::unique_ptr<T>;
template <class T> using scoped_array = std::unique_ptr<T[]>;
template <class T> using shared_array = std::shared_ptr<T[]>;
template <class M> struct ri_lock : std::lock_guard<M> { using std::lock_guard<M>::lock_guard; };

// Mutexes of Boost name their lock.
struct mutex : std::mutex { typedef boost::unique_lock<mutex> scoped_lock; typedef boost::unique_lock<mutex> scoped_try_lock; };
struct recursive_mutex : std::recursive_mutex { typedef boost::unique_lock<recursive_mutex> scoped_lock; };

template <class T> struct optional : std::optional<T> {
  using std::optional<T>::optional;
  optional() = default;
  const T &get() const { return this->value(); }
  T &get() { return this->value(); }
  bool is_initialized() const { return this->has_value(); }
};
inline constexpr std::nullopt_t none = std::nullopt;
template <class F, class... A> auto bind(F &&callee, A &&...a) {
  return std::bind(std::forward<F>(callee), std::forward<A>(a)...);
}
template <class R, class F, class... A> auto bind(F &&callee, A &&...a) {
  return std::bind<R>(std::forward<F>(callee), std::forward<A>(a)...);
}
namespace placeholders { using namespace std::placeholders; }
template <class T, class S> T lexical_cast(const S &from) {
  if constexpr (std::is_arithmetic<S>::value && std::is_same<T, std::string>::value) return std::to_string(from);
  else if constexpr (std::is_floating_point<T>::value) return static_cast<T>(std::stod(from));
  else if constexpr (std::is_integral<T>::value) return static_cast<T>(std::stoll(from));
  else return T(from);
}
using bad_lexical_cast = std::invalid_argument;
template <class T> bool isnan(T v) { return std::isnan(v); }
namespace math {
template <class T> bool isnan(T v) { return std::isnan(v); }
template <class T> bool isinf(T v) { return std::isinf(v); }
template <class T> bool isfinite(T v) { return std::isfinite(v); }
template <class T> T round(T v) { return std::round(v); }
namespace constants { template <class T> constexpr T pi() { return static_cast<T>(3.14159265358979323846L); } }
}  // namespace math
namespace algorithm {
inline bool starts_with(const std::string &a, const std::string &b) { return a.compare(0, b.size(), b) == 0; }
inline bool ends_with(const std::string &a, const std::string &b) {
  return a.size() >= b.size() && a.compare(a.size() - b.size(), b.size(), b) == 0;
}
inline bool contains(const std::string &a, const std::string &b) { return a.find(b) != std::string::npos; }
inline bool iequals(const std::string &a, const std::string &b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}
inline void to_lower(std::string &a) { for (char &c : a) c = std::tolower(static_cast<unsigned char>(c)); }
inline void to_upper(std::string &a) { for (char &c : a) c = std::toupper(static_cast<unsigned char>(c)); }
inline std::string to_lower_copy(std::string a) { to_lower(a); return a; }
inline std::string to_upper_copy(std::string a) { to_upper(a); return a; }
inline void trim(std::string &a) {
  size_t first = 0, last = a.size();
  while (first < last && std::isspace(static_cast<unsigned char>(a[first]))) ++first;
  while (last > first && std::isspace(static_cast<unsigned char>(a[last - 1]))) --last;
  a = a.substr(first, last - first);
}
struct ri_any_of { std::string marks; bool operator()(char c) const { return marks.find(c) != std::string::npos; } };
inline ri_any_of is_any_of(const std::string &marks) { return {marks}; }
enum token_compress_mode_type { token_compress_on, token_compress_off };
template <class C, class P> C &split(C &into, const std::string &text, P is_mark, token_compress_mode_type mode = token_compress_off) {
  into.clear();
  std::string piece;
  for (char c : text) {
    if (!is_mark(c)) { piece.push_back(c); continue; }
    if (mode == token_compress_off || !piece.empty()) into.push_back(piece);
    piece.clear();
  }
  into.push_back(piece);
  return into;
}
}  // namespace algorithm
using namespace algorithm;
namespace this_thread {
inline void interruption_point() {}
template <class D> void sleep(const D &) {}
template <class D> void sleep_for(const D &) {}
using std::this_thread::get_id; using std::this_thread::yield;
}  // namespace this_thread
namespace chrono = std::chrono;
namespace posix_time {
struct ri_duration { long long us = 0; long long total_milliseconds() const { return us / 1000; } };
inline ri_duration milliseconds(long long v) { return {v * 1000}; }
inline ri_duration seconds(long long v) { return {v * 1000000}; }
inline ri_duration microseconds(long long v) { return {v}; }
}  // namespace posix_time
struct noncopyable { noncopyable() = default; noncopyable(const noncopyable &) = delete; };
}  // namespace boost
#define BOOST_FOREACH(declaration, range) for (declaration : range)
#define BOOST_THROW_EXCEPTION(error) throw error
#define BOOST_ASSERT(condition) assert(condition)
#define BOOST_STATIC_ASSERT(condition) static_assert(condition, #condition)
