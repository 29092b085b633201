// cv_bridge, and of OpenCV what it gives: images whose size and type are known and whose pixels are not.
#pragma once
#if RI_ROS == 1
#include <ros/ros.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
namespace ri { namespace pictures = ::sensor_msgs; namespace headings = ::std_msgs; }
#else
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/compressed_image.hpp>
#include <sensor_msgs/msg/image.hpp>
namespace ri { namespace pictures = ::sensor_msgs::msg; namespace headings = ::std_msgs::msg; }
#endif
#include "ri_encodings.hpp"

#ifndef CV_8U
#define CV_8U 0
#define CV_8S 1
#define CV_16U 2
#define CV_16S 3
#define CV_32S 4
#define CV_32F 5
#define CV_64F 6
#define CV_16F 7
#define CV_MAT_DEPTH(flags) ((flags) & 7)
#define CV_MAKETYPE(depth, channels) (CV_MAT_DEPTH(depth) + (((channels) - 1) << 3))
#define CV_MAKE_TYPE CV_MAKETYPE
#define CV_MAT_CN(flags) ((((flags) >> 3) & 511) + 1)
#define CV_MAT_TYPE(flags) ((flags) & 4095)
#define CV_8UC1 CV_MAKETYPE(CV_8U, 1)
#define CV_8UC2 CV_MAKETYPE(CV_8U, 2)
#define CV_8UC3 CV_MAKETYPE(CV_8U, 3)
#define CV_8UC4 CV_MAKETYPE(CV_8U, 4)
#define CV_8UC(n) CV_MAKETYPE(CV_8U, (n))
#define CV_8SC1 CV_MAKETYPE(CV_8S, 1)
#define CV_16UC1 CV_MAKETYPE(CV_16U, 1)
#define CV_16UC3 CV_MAKETYPE(CV_16U, 3)
#define CV_16UC4 CV_MAKETYPE(CV_16U, 4)
#define CV_16SC1 CV_MAKETYPE(CV_16S, 1)
#define CV_32SC1 CV_MAKETYPE(CV_32S, 1)
#define CV_32FC1 CV_MAKETYPE(CV_32F, 1)
#define CV_32FC2 CV_MAKETYPE(CV_32F, 2)
#define CV_32FC3 CV_MAKETYPE(CV_32F, 3)
#define CV_32FC4 CV_MAKETYPE(CV_32F, 4)
#define CV_64FC1 CV_MAKETYPE(CV_64F, 1)
#define CV_64FC2 CV_MAKETYPE(CV_64F, 2)
#define CV_64FC3 CV_MAKETYPE(CV_64F, 3)
#endif
typedef unsigned char uchar;

namespace cv {
struct Exception : std::exception {
  std::string msg, err;
  int code = 0;
  Exception() = default;
  explicit Exception(const std::string &text) : msg(text), err(text) {}
  const char *what() const noexcept override { return msg.c_str(); }
};

// An image. What code that is not here does to one that it is handed is not known.
struct Mat : ri::Anything {
  int rows = 0, cols = 0, ri_type = 0;
  Mat() = default;
  Mat(const Mat &) = default;
  Mat(int height, int width, int type) : rows(height), cols(width), ri_type(CV_MAT_TYPE(type)) {}
  template <class A, class... B, class = std::enable_if_t<!std::is_base_of<Mat, std::decay_t<A>>::value>>
  explicit Mat(A &&, B &&...) { ri_lose(); }
  template <class A, class = std::enable_if_t<std::is_base_of<ri::Anything, std::decay_t<A>>::value &&
                                              !std::is_base_of<Mat, std::decay_t<A>>::value>, class = void>
  Mat(A &&) { ri_lose(); }
  Mat(const Mat &, const ri::Anything &) { ri_lose(); }
  // Where it is a member, others see it; its pixels are not watched.
  Mat &operator=(const Mat &from) {
    ri::foreign("an image"); rows = from.rows; cols = from.cols; ri_type = from.ri_type; return *this;
  }
  template <class A, class = std::enable_if_t<!std::is_base_of<Mat, std::decay_t<A>>::value>>
  Mat &operator=(A &&) { ri_lose(); return *this; }
  void ri_lose() {
    ri::foreign("an image");
    ri_forget(&rows, sizeof(rows)); ri_forget(&cols, sizeof(cols)); ri_forget(&ri_type, sizeof(ri_type));
  }
  void ri_fill() {
    rows = static_cast<int>(ri_integer("rows", 32, 1)); cols = static_cast<int>(ri_integer("cols", 32, 1));
    ri_type = static_cast<int>(ri_integer("type", 32, 1));
    ri_assume((rows >= 0) & (cols >= 0) & (ri_type >= 0) & (ri_type < 4096));
  }
  template <class... A> void create(A &&...) { ri_lose(); }
  template <class... A> void resize(A &&...) { ri_lose(); }
  template <class... A> void push_back(A &&...) { ri_lose(); }
  template <class... A> void pop_back(A &&...) { ri_lose(); }
  void release() { rows = cols = 0; }
  Mat clone() const { return *this; }
  void copyTo(Mat &to) const { to = *this; }
  bool empty() const { return (rows == 0) | (cols == 0); }
  int type() const { return ri_type; }
  int depth() const { return CV_MAT_DEPTH(ri_type); }
  int channels() const { return CV_MAT_CN(ri_type); }
  size_t total() const { return static_cast<size_t>(rows) * static_cast<size_t>(cols); }
};
}  // namespace cv

namespace cv_bridge {
class Exception : public std::runtime_error {
 public:
  explicit Exception(const std::string &text) : std::runtime_error(text) {}
};
typedef enum { BMP, DIB, JPG, JPEG, JPE, JP2, PNG, PBM, PGM, PPM, SR, RAS, TIFF, TIF } Format;

class CvImage;
#if RI_ROS == 1
typedef boost::shared_ptr<CvImage> CvImagePtr;
typedef boost::shared_ptr<CvImage const> CvImageConstPtr;
using RiImagePtr = boost::shared_ptr<ri::pictures::Image>;
using RiCompressedPtr = boost::shared_ptr<ri::pictures::CompressedImage>;
using RiOwner = boost::shared_ptr<void const>;
#else
typedef std::shared_ptr<CvImage> CvImagePtr;
typedef std::shared_ptr<CvImage const> CvImageConstPtr;
using RiImagePtr = std::shared_ptr<ri::pictures::Image>;
using RiCompressedPtr = std::shared_ptr<ri::pictures::CompressedImage>;
using RiOwner = std::shared_ptr<void const>;
#endif

class CvImage {
 public:
  ri::headings::Header header;
  std::string encoding;
  cv::Mat image;
  CvImage() = default;
  CvImage(const ri::headings::Header &given, const std::string &name, const cv::Mat &picture = cv::Mat())
      : header(given), encoding(name), image(picture) {}
  typedef CvImagePtr Ptr;
  typedef CvImageConstPtr ConstPtr;
  RiImagePtr toImageMsg() const { RiImagePtr made(new ri::pictures::Image()); toImageMsg(*made); return made; }
  void toImageMsg(ri::pictures::Image &made) const {
    made.header = header; made.height = image.rows; made.width = image.cols; made.encoding = encoding;
    made.is_bigendian = false;
    ri::foreign("cv_bridge::CvImage::toImageMsg", made.data);
  }
  RiCompressedPtr toCompressedImageMsg(Format format = JPG) const {
    RiCompressedPtr made(new ri::pictures::CompressedImage()); toCompressedImageMsg(*made, format); return made;
  }
  void toCompressedImageMsg(ri::pictures::CompressedImage &made, Format = JPG) const {
    made.header = header;
    ri::foreign("cv_bridge::CvImage::toCompressedImageMsg", made.format, made.data);
  }
};

inline ri::Encoding ri_read_type(const std::string &encoding) {
  const ri::Encoding read = ri::read_encoding(encoding);
  ri::require_release(read);
  if (read.form == ri::Encoding::MANY_CHANNELS) ri_unknown("an encoding with this number of channels");
  if ((read.form == ri::Encoding::WRONG) | (read.form == ri::Encoding::NO_CHANNELS)) throw Exception("Unrecognized image encoding");
  return read;
}
inline int getCvType(const std::string &encoding) {
  const ri::Encoding read = ri_read_type(encoding);
  return CV_MAKETYPE(read.depth, read.form == ri::Encoding::DEPTH_ALONE ? 1 : read.channels);
}

// The image of a message, once its encoding and its sizes fit together.
inline cv::Mat ri_share(const ri::pictures::Image &source, const ri::Encoding &read) {
  if (read.form == ri::Encoding::DEPTH_ALONE) throw std::runtime_error("Unknown encoding");
  const uint32_t shift = read.depth < 2 ? 0 : read.depth < 4 ? 1 : read.depth < 6 ? 2 : 3;
  if (source.step < source.width * (static_cast<uint32_t>(read.channels) << shift))
    throw Exception("Image is wrongly formed: step < width * byte_depth * num_channels");
  if (source.height * source.step != source.data.size())
    throw Exception("Image is wrongly formed: height * step != size");
  // What OpenCV makes of these depends on how it was built.
  if ((source.height > INT32_MAX) | (source.width > INT32_MAX)) ri_unknown("an image with more rows or columns than an int");
  if ((source.step & ((1u << shift) - 1)) != 0) ri_unknown("an image whose rows end within a pixel");
  return cv::Mat(static_cast<int>(source.height), static_cast<int>(source.width), CV_MAKETYPE(read.depth, read.channels));
}

// Whether colours are converted from one order to another; throws where they cannot be. from: one that has channels.
inline bool ri_converts(const ri::Encoding &from, const ri::Encoding &to) {
  ri::require_encoding(to);
  if (!from.has_colors() & to.has_colors()) throw Exception("not a color format, and the other is. The conversion does not make sense");
  if (!from.has_colors() | !to.has_colors()) {
    if (from.channels != to.channels) throw Exception("not the same number of channels");
    return false;
  }
  if ((from.order == to.order) & (from.order <= ri::Encoding::YUV422)) return false;
  const bool can = (to.order <= ri::Encoding::BGR) | (!from.is_bayer & (to.order <= ri::Encoding::BGRA));
  if (!can) throw Exception("Unsupported conversion");
  return true;
}
inline CvImagePtr ri_make(const cv::Mat &image, const ri::headings::Header &header, const std::string &encoding) {
  CvImagePtr made(new CvImage());
#if RI_ROS == 1
  made->header.seq = header.seq;
#endif
  made->header.stamp = header.stamp;
  ri::copy_text(made->header.frame_id, header.frame_id);
  ri::copy_text(made->encoding, encoding);
  made->image.rows = image.rows; made->image.cols = image.cols; made->image.ri_type = image.ri_type;
  return made;
}
inline CvImagePtr ri_copy(const cv::Mat &image, const ri::Encoding &read, const ri::headings::Header &header, const std::string &source, const std::string &wanted) {
  if (wanted.empty() || ri::is_same_text(source, wanted)) return ri_make(image, header, source);
  const ri::Encoding to = ri::read_encoding(wanted);
  if (ri_converts(read, to)) {
    if (image.empty()) throw cv::Exception("(-215:Assertion failed) !_src.empty() in function 'cvtColor'");
    if ((read.order == ri::Encoding::YUV422) & (image.cols % 2 != 0)) ri_unknown("an image of yuv422 with an odd width");
  } else if (to.form == ri::Encoding::NO_CHANNELS) throw Exception("Unrecognized image encoding");
  CvImagePtr made = ri_make(image, header, wanted);
  made->image.ri_type = CV_MAKETYPE(to.depth, to.has_colors() ? to.channels : image.channels());
  return made;
}

inline CvImagePtr toCvCopy(const ri::pictures::Image &source, const std::string &encoding = std::string()) {
  const ri::Encoding read = ri_read_type(source.encoding);
  return ri_copy(ri_share(source, read), read, source.header, source.encoding, encoding);
}
inline CvImagePtr toCvCopy(const ri::pictures::CompressedImage &source, const std::string &encoding = std::string()) {
  CvImagePtr made(new CvImage(source.header, encoding.empty() ? std::string("bgr8") : encoding));
  made->image.ri_lose();
  return made;
}
template <class P, class = decltype(toCvCopy(*std::declval<const P &>()))>
inline CvImagePtr toCvCopy(const P &source, const std::string &encoding = std::string()) { return toCvCopy(*source, encoding); }
inline CvImageConstPtr toCvShare(const ri::pictures::Image &source, const RiOwner &, const std::string &encoding = std::string()) {
  if ((!encoding.empty() && !ri::is_same_text(source.encoding, encoding)) || source.is_bigendian) return toCvCopy(source, encoding);
  return ri_make(ri_share(source, ri_read_type(source.encoding)), source.header, source.encoding);
}
template <class P, class = decltype(toCvCopy(*std::declval<const P &>()))>
inline CvImageConstPtr toCvShare(const P &source, const std::string &encoding = std::string()) { return toCvShare(*source, RiOwner(), encoding); }
inline CvImagePtr cvtColor(const CvImageConstPtr &source, const std::string &encoding) {
  return ri_copy(source->image, ri::read_encoding(source->encoding), source->header, source->encoding, encoding);
}
struct CvtColorForDisplayOptions {
  bool do_dynamic_scaling = false;
  double min_image_value = 0.0, max_image_value = 0.0;
  int colormap = -1, bg_label = -1;
};
inline CvImageConstPtr cvtColorForDisplay(const CvImageConstPtr &source, const std::string &encoding = std::string(), const CvtColorForDisplayOptions = {}) {
  ri_unknown("cv_bridge::cvtColorForDisplay");
  return CvImageConstPtr(new CvImage(source->header, encoding, source->image));
}
}  // namespace cv_bridge
