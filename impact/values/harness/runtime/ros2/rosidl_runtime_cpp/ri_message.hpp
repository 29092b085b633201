// What generated messages of ROS 2 are made with.
#pragma once
#include "ri_core.hpp"

namespace rosidl_runtime_cpp {
enum class MessageInitialization { ALL, SKIP, ZERO, DEFAULTS_ONLY };

// A vector with a bound, as rosidl_runtime_cpp::BoundedVector.
template <class T, size_t N, class A = std::allocator<T>> class BoundedVector : protected std::vector<T> {
  using Base = std::vector<T>;
  static void check(size_t size) { if (size > N) throw std::length_error("Exceeded upper bound"); }
 public:
  static constexpr size_t ri_bound = N;
  Base &ri_base() { return *this; }
  using typename Base::value_type; using typename Base::iterator; using typename Base::const_iterator;
  using typename Base::reference; using typename Base::const_reference; using typename Base::size_type;
  BoundedVector() = default;
  BoundedVector(std::initializer_list<T> from) : Base((check(from.size()), from)) {}
  explicit BoundedVector(size_t size) : Base((check(size), size)) {}
  BoundedVector(size_t size, const T &value) : Base((check(size), size), value) {}
  template <class I, class = typename std::iterator_traits<I>::iterator_category>
  BoundedVector(I first, I last) : Base(first, last) { check(Base::size()); }
  BoundedVector(const Base &from) : Base((check(from.size()), from)) {}
  BoundedVector &operator=(const Base &from) { check(from.size()); Base::operator=(from); return *this; }
  BoundedVector &operator=(std::initializer_list<T> from) { check(from.size()); Base::operator=(from); return *this; }
  using Base::begin; using Base::end; using Base::cbegin; using Base::cend; using Base::rbegin; using Base::rend;
  using Base::size; using Base::empty; using Base::capacity; using Base::operator[]; using Base::at;
  using Base::front; using Base::back; using Base::data; using Base::clear; using Base::erase; using Base::pop_back;
  size_t max_size() const { return N; }
  void resize(size_t size) { check(size); Base::resize(size); }
  void resize(size_t size, const T &value) { check(size); Base::resize(size, value); }
  void reserve(size_t size) { check(size); Base::reserve(size); }
  void assign(size_t size, const T &value) { check(size); Base::assign(size, value); }
  template <class I, class = typename std::iterator_traits<I>::iterator_category>
  void assign(I first, I last) { Base made(first, last); check(made.size()); Base::operator=(made); }
  void push_back(const T &value) { check(size() + 1); Base::push_back(value); }
  template <class... B> auto &emplace_back(B &&...b) {
    check(size() + 1); Base::emplace_back(std::forward<B>(b)...); return Base::back();
  }
  bool operator==(const BoundedVector &other) const {
    return static_cast<const Base &>(*this) == static_cast<const Base &>(other);
  }
  bool operator!=(const BoundedVector &other) const { return !(*this == other); }
};
}  // namespace rosidl_runtime_cpp
