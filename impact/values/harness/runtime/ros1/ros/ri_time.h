// ros::Time, ros::Duration and ros::Rate. Times are inputs; nothing sleeps.
#pragma once
#include "ri_core.hpp"

namespace ros {
struct TimeNotInitializedException : std::runtime_error { using std::runtime_error::runtime_error; };

template <class T> struct DurationBase {
  using ri_is_message = void;
  int32_t sec = 0, nsec = 0;
  DurationBase() = default;
  DurationBase(int32_t s, int32_t n) { set(static_cast<int64_t>(s) * 1000000000LL + n); }
  explicit DurationBase(double t) { fromSec(t); }
  void set(int64_t total) {
    int64_t s = total / 1000000000LL, n = total % 1000000000LL;
    if (n < 0) { n += 1000000000LL; --s; }
    if (s > INT32_MAX || s < INT32_MIN) throw std::runtime_error("Duration is out of dual 32-bit range");
    sec = static_cast<int32_t>(s); nsec = static_cast<int32_t>(n);
  }
  T &fromSec(double t) {
    if (!(t >= -2147483648.0 && t < 2147483648.0)) throw std::runtime_error("Duration is out of dual 32-bit range");
    set(static_cast<int64_t>(t) * 1000000000LL + static_cast<int64_t>((t - static_cast<double>(static_cast<int64_t>(t))) * 1e9));
    return static_cast<T &>(*this);
  }
  T &fromNSec(int64_t t) { set(t); return static_cast<T &>(*this); }
  double toSec() const { return sec + 1e-9 * nsec; }
  int64_t toNSec() const { return static_cast<int64_t>(sec) * 1000000000LL + nsec; }
  bool isZero() const { return sec == 0 && nsec == 0; }
  bool sleep() const { return true; }
  T operator+(const T &o) const { T r; r.set(toNSec() + o.toNSec()); return r; }
  T operator-(const T &o) const { T r; r.set(toNSec() - o.toNSec()); return r; }
  T operator-() const { T r; r.set(-toNSec()); return r; }
  T operator*(double s) const { return T(toSec() * s); }
  T &operator+=(const T &o) { set(toNSec() + o.toNSec()); return static_cast<T &>(*this); }
  T &operator-=(const T &o) { set(toNSec() - o.toNSec()); return static_cast<T &>(*this); }
  bool operator==(const T &o) const { return sec == o.sec && nsec == o.nsec; }
  bool operator!=(const T &o) const { return !(*this == o); }
  bool operator<(const T &o) const { return toNSec() < o.toNSec(); }
  bool operator>(const T &o) const { return toNSec() > o.toNSec(); }
  bool operator<=(const T &o) const { return toNSec() <= o.toNSec(); }
  bool operator>=(const T &o) const { return toNSec() >= o.toNSec(); }
  template <class V, class M> static void ri_each(V &visit, M &m) { visit("sec", m.sec); visit("nsec", m.nsec); }
};
struct Duration : DurationBase<Duration> { using DurationBase<Duration>::DurationBase; Duration() = default; };
struct WallDuration : DurationBase<WallDuration> { using DurationBase<WallDuration>::DurationBase; WallDuration() = default; };

template <class T, class D> struct TimeBase {
  using ri_is_message = void;
  uint32_t sec = 0, nsec = 0;
  TimeBase() = default;
  TimeBase(uint32_t s, uint32_t n) { set(static_cast<uint64_t>(s) * 1000000000ULL + n); }
  explicit TimeBase(double t) { fromSec(t); }
  void set(uint64_t total) {
    if (total / 1000000000ULL > UINT32_MAX) throw std::runtime_error("Time is out of dual 32-bit range");
    sec = static_cast<uint32_t>(total / 1000000000ULL); nsec = static_cast<uint32_t>(total % 1000000000ULL);
  }
  T &fromSec(double t) {
    if (!(t >= 0 && t < 4294967296.0)) throw std::runtime_error("Time is out of dual 32-bit range");
    uint64_t whole = static_cast<uint64_t>(t);
    set(whole * 1000000000ULL + static_cast<uint64_t>((t - static_cast<double>(whole)) * 1e9));
    return static_cast<T &>(*this);
  }
  T &fromNSec(uint64_t t) { set(t); return static_cast<T &>(*this); }
  double toSec() const { return static_cast<double>(sec) + 1e-9 * nsec; }
  uint64_t toNSec() const { return static_cast<uint64_t>(sec) * 1000000000ULL + nsec; }
  bool isZero() const { return sec == 0 && nsec == 0; }
  bool is_zero() const { return isZero(); }
  D operator-(const T &o) const { D r; r.set(static_cast<int64_t>(toNSec()) - static_cast<int64_t>(o.toNSec())); return r; }
  T operator+(const D &o) const { return shift(o.toNSec()); }
  T operator-(const D &o) const { return shift(-o.toNSec()); }
  T &operator+=(const D &o) { return static_cast<T &>(*this) = *this + o; }
  T &operator-=(const D &o) { return static_cast<T &>(*this) = *this - o; }
  T shift(int64_t by) const {
    int64_t total = static_cast<int64_t>(toNSec()) + by;
    if (total < 0) throw std::runtime_error("Time is out of dual 32-bit range");
    T r; r.set(static_cast<uint64_t>(total)); return r;
  }
  bool operator==(const T &o) const { return sec == o.sec && nsec == o.nsec; }
  bool operator!=(const T &o) const { return !(*this == o); }
  bool operator<(const T &o) const { return toNSec() < o.toNSec(); }
  bool operator>(const T &o) const { return toNSec() > o.toNSec(); }
  bool operator<=(const T &o) const { return toNSec() <= o.toNSec(); }
  bool operator>=(const T &o) const { return toNSec() >= o.toNSec(); }
  static T now() {
    static int asked = 0;
    static uint32_t sec = 0, nsec = 0;
    T r;
    ri_enter("~now"); ri_enter_index(asked);
    r.sec = static_cast<uint32_t>(ri_integer("sec", 32, 0));
    r.nsec = static_cast<uint32_t>(ri_integer("nsec", 32, 0));
    ri_leave(); ri_leave();
    ri_assume(r.nsec < 1000000000u);
    ri_assume(r.sec < 2147483648u);
    // Not before a time that was given already.
    if (asked++) ri_assume((r.sec > sec) | ((r.sec == sec) & (r.nsec >= nsec)));
    sec = r.sec; nsec = r.nsec;
    return r;
  }
  static bool isValid() { return true; }
  static bool isSystemTime() { return true; }
  static bool waitForValid() { return true; }
  template <class W> static bool waitForValid(const W &) { return true; }
  static void init() {}
  static bool sleepUntil(const T &) { return true; }
  template <class V, class M> static void ri_each(V &visit, M &m) { visit("sec", m.sec); visit("nsec", m.nsec); }
};
struct Time : TimeBase<Time, Duration> {
  using TimeBase<Time, Duration>::TimeBase; Time() = default;
  static void setNow(const Time &) {}
  static bool isSimTime() { return false; }
};
struct WallTime : TimeBase<WallTime, WallDuration> { using TimeBase<WallTime, WallDuration>::TimeBase; WallTime() = default; };
struct SteadyTime : TimeBase<SteadyTime, WallDuration> { using TimeBase<SteadyTime, WallDuration>::TimeBase; SteadyTime() = default; };
inline std::ostream &operator<<(std::ostream &out, const Time &) { return out; }
inline std::ostream &operator<<(std::ostream &out, const Duration &) { return out; }
inline const Duration DURATION_MAX(INT32_MAX, 999999999);
inline const Duration DURATION_MIN(INT32_MIN, 0);
inline const Time TIME_MIN(0, 1);
inline const Time TIME_MAX(UINT32_MAX, 999999999);

struct Rate {
  explicit Rate(double) {}
  explicit Rate(const Duration &) {}
  bool sleep() { return true; }
  void reset() {}
  Duration expectedCycleTime() const { return Duration(); }
  Duration cycleTime() const { return Duration(); }
};
struct WallRate {
  explicit WallRate(double) {}
  explicit WallRate(const Duration &) {}
  bool sleep() { return true; }
  void reset() {}
};
}  // namespace ros
