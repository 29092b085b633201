// sensor_msgs/point_cloud2_iterator and point_cloud_conversion: fields of clouds by their names, as bytes of the message.
#pragma once
#include <cstdarg>
#if RI_ROS == 1
#include <sensor_msgs/PointCloud2.h>
namespace ri { namespace clouds = ::sensor_msgs; }
#else
#include <sensor_msgs/msg/point_cloud2.hpp>
namespace ri { namespace clouds = ::sensor_msgs::msg; }
#endif
#include "ri_core.hpp"

namespace ri {
inline int measure_point_field(int type) {
  switch (type) {
    case clouds::PointField::INT8: case clouds::PointField::UINT8: return 1;
    case clouds::PointField::INT16: case clouds::PointField::UINT16: return 2;
    case clouds::PointField::INT32: case clouds::PointField::UINT32: case clouds::PointField::FLOAT32: return 4;
    case clouds::PointField::FLOAT64: return 8;
    default: throw std::runtime_error("PointField does not exist");
  }
}
// Gives where the next field may begin.
inline int add_point_field(clouds::PointCloud2 &cloud, const std::string &name, int count, int type, int offset) {
  clouds::PointField made;
  made.name = name; made.count = count; made.datatype = type; made.offset = offset;
  cloud.fields.push_back(made);
  return offset + made.count * measure_point_field(type);
}
inline void fit_point_fields(clouds::PointCloud2 &cloud, int step) {
  cloud.point_step = step;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.height * cloud.row_step);
}
}  // namespace ri

namespace sensor_msgs {
class PointCloud2Modifier {
 public:
  explicit PointCloud2Modifier(ri::clouds::PointCloud2 &cloud) : ri_cloud(cloud) {}
  size_t size() const { return ri_cloud.data.size() / ri_cloud.point_step; }
  void reserve(size_t size) { ri_cloud.data.reserve(size * ri_cloud.point_step); }
  void resize(size_t size) { ri_cloud.data.resize(size * ri_cloud.point_step); ri_fit(size); }
  void clear() {
    ri_cloud.data.clear();
    if (ri_cloud.height == 1) ri_cloud.row_step = ri_cloud.width = 0;
    else if (ri_cloud.width == 1) ri_cloud.height = 0;
    else ri_cloud.row_step = ri_cloud.width = ri_cloud.height = 0;
  }
  // For each field its name, the number of its elements and their type.
  template <class... A> void setPointCloud2Fields(int count, A... given) {
    ri_cloud.fields.clear();
    ri_fit_to(ri_add(count, 0, given...));
  }
  template <class... A> void setPointCloud2FieldsByString(int count, A... given) {
    ri_cloud.fields.clear();
    const std::string names[] = {std::string(), std::string(given)...};
    int offset = 0;
    for (int at = 1; at <= count && at <= static_cast<int>(sizeof...(given)); ++at) {
      const std::string &name = names[at];
      if (name == "xyz") {
        for (const char *each : {"x", "y", "z"})
          offset = ri::add_point_field(ri_cloud, each, 1, ri::clouds::PointField::FLOAT32, offset);
        offset += 4;
      } else if (name == "rgb" || name == "rgba") {
        offset = ri::add_point_field(ri_cloud, name, 1, ri::clouds::PointField::FLOAT32, offset) + 12;
      } else throw std::runtime_error("Field " + name + " does not exist");
    }
    ri_fit_to(offset);
  }

 private:
  int ri_add(int, int offset) { return offset; }
  template <class... A> int ri_add(int left, int offset, const char *name, int count, int type, A... given) {
    if (left <= 0) return offset;
    return ri_add(left - 1, ri::add_point_field(ri_cloud, name, count, type, offset), given...);
  }
  void ri_fit_to(int step) { ri::fit_point_fields(ri_cloud, step); }
  void ri_fit(size_t size) {
    if (ri_cloud.height != 1 && ri_cloud.width == 1) { ri_cloud.height = size; return; }
    ri_cloud.height = 1;
    ri_cloud.width = size;
    ri_cloud.row_step = size * ri_cloud.point_step;
  }
  ri::clouds::PointCloud2 &ri_cloud;
};

namespace impl {
template <class T, class TT, class U, class C, template <class> class V> class PointCloud2IteratorBase {
 public:
  PointCloud2IteratorBase() = default;
  PointCloud2IteratorBase(C &cloud, const std::string &name) {
    const int offset = ri_find(cloud, name);
    // An empty cloud has a beginning and an end, too: nothing is read for them.
    ri_at = cloud.data.data() + offset;
    ri_end = cloud.data.data() + cloud.data.size() + offset;
  }
  V<T> &operator=(const V<T> &from) {
    ri_step = from.ri_step; ri_at = from.ri_at; ri_end = from.ri_end;
    return *static_cast<V<T> *>(this);
  }
  TT &operator[](size_t at) const { return *(reinterpret_cast<TT *>(ri_at) + at); }
  TT &operator*() const { return *reinterpret_cast<TT *>(ri_at); }
  V<T> &operator++() { ri_at += ri_step; return *static_cast<V<T> *>(this); }
  V<T> operator+(int count) { V<T> made = *static_cast<V<T> *>(this); made.ri_at += count * ri_step; return made; }
  V<T> &operator+=(int count) { ri_at += count * ri_step; return *static_cast<V<T> *>(this); }
  bool operator!=(const V<T> &other) const { return ri_at != other.ri_at; }
  bool operator==(const V<T> &other) const { return ri_at == other.ri_at; }
  V<T> end() const { V<T> made = *static_cast<const V<T> *>(this); made.ri_at = ri_end; return made; }
  int ri_step = 0;
  U *ri_at = nullptr, *ri_end = nullptr;

 private:
  // Where a field begins in a point.
  int ri_find(const ri::clouds::PointCloud2 &cloud, const std::string &name) {
    ri_step = cloud.point_step;
    for (const auto &field : cloud.fields) if (field.name == name) return field.offset;
    const bool is_big = cloud.is_bigendian;
    const int at = name == "r" ? (is_big ? 1 : 2) : name == "g" ? (is_big ? 2 : 1) : name == "b" ? (is_big ? 3 : 0) :
                   name == "a" ? (is_big ? 0 : 3) : -1;
    if (at >= 0)
      for (const auto &field : cloud.fields) if (field.name == "rgb" || field.name == "rgba") return field.offset + at;
    throw std::runtime_error("Field " + name + " does not exist");
  }
};
}  // namespace impl

template <class T> class PointCloud2Iterator
    : public impl::PointCloud2IteratorBase<T, T, unsigned char, ri::clouds::PointCloud2, PointCloud2Iterator> {
 public:
  using impl::PointCloud2IteratorBase<T, T, unsigned char, ri::clouds::PointCloud2, sensor_msgs::PointCloud2Iterator>::PointCloud2IteratorBase;
};
template <class T> class PointCloud2ConstIterator
    : public impl::PointCloud2IteratorBase<T, const T, const unsigned char, const ri::clouds::PointCloud2, PointCloud2ConstIterator> {
 public:
  using impl::PointCloud2IteratorBase<T, const T, const unsigned char, const ri::clouds::PointCloud2, sensor_msgs::PointCloud2ConstIterator>::PointCloud2IteratorBase;
};
}  // namespace sensor_msgs
