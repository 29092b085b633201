// sensor_msgs/image_encodings: the names of encodings and what is asked of them. An encoding is compared as numbers, so
// that one whose text is not known takes a few ways and not one for each name.
#pragma once
#include "ri_core.hpp"

namespace sensor_msgs {
namespace image_encodings {
#if RI_ROS == 1
#define RI_ENCODING(NAME, text) const std::string NAME = text;
#else
#define RI_ENCODING(NAME, text) const char NAME[] = text;
#endif
RI_ENCODING(RGB8, "rgb8") RI_ENCODING(RGBA8, "rgba8") RI_ENCODING(RGB16, "rgb16") RI_ENCODING(RGBA16, "rgba16")
RI_ENCODING(BGR8, "bgr8") RI_ENCODING(BGRA8, "bgra8") RI_ENCODING(BGR16, "bgr16") RI_ENCODING(BGRA16, "bgra16")
RI_ENCODING(MONO8, "mono8") RI_ENCODING(MONO16, "mono16")
#define RI_CHANNELS(T)                                                                                      \
  RI_ENCODING(TYPE_##T##1, #T "1") RI_ENCODING(TYPE_##T##2, #T "2") RI_ENCODING(TYPE_##T##3, #T "3")        \
  RI_ENCODING(TYPE_##T##4, #T "4")
RI_CHANNELS(8UC) RI_CHANNELS(8SC) RI_CHANNELS(16UC) RI_CHANNELS(16SC) RI_CHANNELS(32SC) RI_CHANNELS(32FC)
RI_CHANNELS(64FC)
#undef RI_CHANNELS
RI_ENCODING(BAYER_RGGB8, "bayer_rggb8") RI_ENCODING(BAYER_BGGR8, "bayer_bggr8")
RI_ENCODING(BAYER_GBRG8, "bayer_gbrg8") RI_ENCODING(BAYER_GRBG8, "bayer_grbg8")
RI_ENCODING(BAYER_RGGB16, "bayer_rggb16") RI_ENCODING(BAYER_BGGR16, "bayer_bggr16")
RI_ENCODING(BAYER_GBRG16, "bayer_gbrg16") RI_ENCODING(BAYER_GRBG16, "bayer_grbg16")
RI_ENCODING(YUV422, "yuv422")
#if RI_ROS == 2
RI_ENCODING(YUV422_YUY2, "yuv422_yuy2") RI_ENCODING(UYVY, "uyvy") RI_ENCODING(YUYV, "yuyv")
RI_ENCODING(NV12, "nv12") RI_ENCODING(NV21, "nv21") RI_ENCODING(NV24, "nv24")
#endif
#undef RI_ENCODING
}  // namespace image_encodings
}  // namespace sensor_msgs

namespace ri {

// The first 16 bytes of a text and how many it has.
struct PackedText {
  unsigned char bytes[16] = {};
  uint64_t words[2] = {0, 0};
  uint64_t size = 0;
  explicit PackedText(const std::string &text) : size(text.size()) {
    memcpy(bytes, text.data(), size < sizeof(bytes) ? size : sizeof(bytes));
    memcpy(words, bytes, sizeof(bytes));
  }
  // Eight bytes of a text from one on, as they lie in memory of a machine that begins with the lowest.
  static constexpr uint64_t pack(const char *text, size_t size, size_t from) {
    uint64_t made = 0;
    for (size_t at = from; at < size && at < from + 8; ++at)
      made |= static_cast<uint64_t>(static_cast<unsigned char>(text[at])) << (8 * (at - from));
    return made;
  }
};
// Whether two texts are the same, of which one is known and short: one choice.
inline bool is_same_text(const std::string &one, const std::string &known) {
  if (known.size() > 16) return one == known;
  PackedText first(one), second(known);
  return (first.size == second.size) & (first.words[0] == second.words[0]) & (first.words[1] == second.words[1]);
}
// Copies a text without a choice for each of its sizes.
inline void copy_text(std::string &to, const std::string &from) {
#ifdef RI_SYMBOLIC
  constexpr uint64_t most = 64;
  const uint64_t size = from.size();
  if (size < most) {
    char *bytes = static_cast<char *>(::operator new(most));
    memset(bytes, 0, most);
    memcpy(bytes, from.data(), size);
    auto *layout = reinterpret_cast<TextLayout *>(&to);
    layout->start = bytes; layout->size = size; layout->capacity = size;
    ri_resize(bytes, size + 1);
    return;
  }
#endif
  to = from;
}
// Whether a packed text is a literal.
#define RI_SAME(packed, literal)                                                                            \
  ([](const ri::PackedText &given) {                                                                        \
    constexpr size_t size = sizeof(literal) - 1;                                                            \
    constexpr uint64_t first = ri::PackedText::pack(literal, size, 0), second = ri::PackedText::pack(literal, size, 8); \
    return (given.size == size) & (given.words[0] == first) & (given.words[1] == second);                   \
  }(packed))

// What an encoding says. depth: as OpenCV counts types, 0 for 8U to 6 for 64F. order: what cv_bridge converts colours by.
struct Encoding {
  enum Order { NONE = -1, GRAY, RGB, BGR, RGBA, BGRA, YUV422, RGGB, BGGR, GBRG, GRBG };
  // How far it is known: not at all; one that only some releases know; `8U`, which has a type and no more; `8UC`, which
  // has no type; a number of channels that is not followed; all.
  enum Form { WRONG, SOME_RELEASES, DEPTH_ALONE, NO_CHANNELS, MANY_CHANNELS, KNOWN };
  int form = WRONG, depth = 0, channels = 0, order = NONE;
  bool is_color = false, is_mono = false, is_bayer = false, has_alpha = false;
  int bits() const { return depth < 2 ? 8 : depth < 4 ? 16 : depth < 6 ? 32 : 64; }
  bool has_colors() const { return is_color | is_mono | is_bayer | (order == YUV422); }
};

inline Encoding read_encoding(const std::string &text) {
  PackedText name(text);
  Encoding made;
#define RI_KNOWN(literal, its_depth, its_channels, its_order)                                               \
  { bool is = RI_SAME(name, literal); made.form = is ? Encoding::KNOWN : made.form; made.depth = is ? its_depth : made.depth;  \
    made.channels = is ? its_channels : made.channels; made.order = is ? Encoding::its_order : made.order; }
  RI_KNOWN("mono8", 0, 1, GRAY) RI_KNOWN("mono16", 2, 1, GRAY)
  RI_KNOWN("rgb8", 0, 3, RGB) RI_KNOWN("rgb16", 2, 3, RGB) RI_KNOWN("bgr8", 0, 3, BGR) RI_KNOWN("bgr16", 2, 3, BGR)
  RI_KNOWN("rgba8", 0, 4, RGBA) RI_KNOWN("rgba16", 2, 4, RGBA)
  RI_KNOWN("bgra8", 0, 4, BGRA) RI_KNOWN("bgra16", 2, 4, BGRA) RI_KNOWN("yuv422", 0, 2, YUV422)
  RI_KNOWN("bayer_rggb8", 0, 1, RGGB) RI_KNOWN("bayer_bggr8", 0, 1, BGGR) RI_KNOWN("bayer_gbrg8", 0, 1, GBRG)
  RI_KNOWN("bayer_grbg8", 0, 1, GRBG) RI_KNOWN("bayer_rggb16", 2, 1, RGGB) RI_KNOWN("bayer_bggr16", 2, 1, BGGR)
  RI_KNOWN("bayer_gbrg16", 2, 1, GBRG) RI_KNOWN("bayer_grbg16", 2, 1, GRBG)
#undef RI_KNOWN
  made.is_mono = made.order == Encoding::GRAY;
  made.is_color = (made.order >= Encoding::RGB) & (made.order <= Encoding::BGRA);
  made.has_alpha = (made.order == Encoding::RGBA) | (made.order == Encoding::BGRA);
  made.is_bayer = made.order >= Encoding::RGGB;
#if RI_ROS == 2
  bool is_newer = RI_SAME(name, "yuv422_yuy2") | RI_SAME(name, "uyvy") | RI_SAME(name, "yuyv") | RI_SAME(name, "nv12") | RI_SAME(name, "nv21") |
                  RI_SAME(name, "nv24");
  made.form = is_newer ? Encoding::SOME_RELEASES : made.form;
#endif
  // `32FC3` and the like: a pattern that is matched up to the first byte that is 0.
  int length = 0, prefix = 0, depth = 0;
  bool goes_on = true;
  for (unsigned char each : name.bytes) { goes_on &= each != 0; length += goes_on; }
  length = length == 16 && name.size > 16 ? 17 : length;
#define RI_DEPTH(literal, its_depth)                                                                        \
  { constexpr int size = sizeof(literal) - 1; constexpr uint64_t mask = (uint64_t(1) << (8 * size)) - 1;    \
    constexpr uint64_t wanted = PackedText::pack(literal, size, 0); bool is = (name.words[0] & mask) == wanted;                                  \
    prefix = is ? size : prefix; depth = is ? its_depth : depth; }
  RI_DEPTH("8U", 0) RI_DEPTH("8S", 1) RI_DEPTH("16U", 2) RI_DEPTH("16S", 3) RI_DEPTH("32S", 4) RI_DEPTH("32F", 5)
  RI_DEPTH("64F", 6)
#undef RI_DEPTH
  const bool is_short = prefix == 2;
  const unsigned char letter = is_short ? name.bytes[2] : name.bytes[3];
  const unsigned char digit = is_short ? name.bytes[3] : name.bytes[4];
  bool has_digits = true;
  for (int at = 3; at < 16; ++at) {
    const bool is_inside = (at > prefix) & (at < length);
    has_digits &= !is_inside | ((name.bytes[at] >= '0') & (name.bytes[at] <= '9'));
  }
  const bool is_generic = (prefix > 0) & (letter == 'C');
  const bool is_one = is_generic & (length == prefix + 2) & (digit >= '1') & (digit <= '9');
  const bool is_none = is_generic & (length == prefix + 1);
  const bool is_many = is_generic & !is_one & (length > prefix + 1) & has_digits;
  const bool is_bare = (prefix > 0) & (length == prefix);
  made.form = is_one ? Encoding::KNOWN : is_none ? Encoding::NO_CHANNELS : is_many ? Encoding::MANY_CHANNELS :
              is_bare ? Encoding::DEPTH_ALONE : made.form;
  const bool is_typed = is_one | is_none | is_bare;
  made.depth = is_typed ? depth : made.depth;
  made.channels = is_one ? digit - '0' : is_none ? 1 : made.channels;
  return made;
}

// What the functions that ask for a number of an encoding do with those that are not in the list.
inline void require_encoding(const Encoding &encoding) {
  if (encoding.form == Encoding::SOME_RELEASES) ri_unknown("an encoding that not all releases of sensor_msgs know");
  if (encoding.form == Encoding::MANY_CHANNELS) ri_unknown("an encoding with this number of channels");
  if ((encoding.form == Encoding::WRONG) | (encoding.form == Encoding::DEPTH_ALONE))
    throw std::runtime_error("Unknown encoding");
}
// Whether it says more than a release may know.
inline void require_release(const Encoding &encoding) {
  if (encoding.form == Encoding::SOME_RELEASES) ri_unknown("an encoding that not all releases of sensor_msgs know");
}
}  // namespace ri

namespace sensor_msgs {
namespace image_encodings {
static inline bool isColor(const std::string &encoding) {
  const ri::Encoding read = ri::read_encoding(encoding);
  ri::require_release(read);
#if RI_ROS == 2
  if (read.order == ri::Encoding::YUV422) ri_unknown("whether yuv422 is a color, which changed with a release");
#endif
  return read.is_color;
}
static inline bool isMono(const std::string &encoding) { return ri::read_encoding(encoding).is_mono; }
static inline bool isBayer(const std::string &encoding) { return ri::read_encoding(encoding).is_bayer; }
static inline bool hasAlpha(const std::string &encoding) { return ri::read_encoding(encoding).has_alpha; }
#if RI_ROS == 2
static inline bool isPlanar(const std::string &encoding) {
  ri::PackedText name(encoding);
  return RI_SAME(name, "nv12") | RI_SAME(name, "nv21") | RI_SAME(name, "nv24");
}
#endif
static inline int numChannels(const std::string &encoding) {
  const ri::Encoding read = ri::read_encoding(encoding);
  ri::require_encoding(read);
  return read.channels;
}
static inline int bitDepth(const std::string &encoding) {
  const ri::Encoding read = ri::read_encoding(encoding);
  ri::require_encoding(read);
  return read.bits();
}
}  // namespace image_encodings
}  // namespace sensor_msgs
