// libFuzzer: inputs are taken from its bytes in the order in which they are asked for. With RI_WITNESS set, they are
// written to that file as `path=bits`.
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "rosimpact_values.h"

struct RiEntry { const char *name; void (*run)(); };
extern "C" const RiEntry ri_entries[];
extern "C" void ri_reset();

namespace {
const uint8_t *bytes; size_t left; jmp_buf back; bool begun = false;
std::vector<std::string> &stack() { static std::vector<std::string> made; return made; }
std::map<std::string, uint64_t> &known() { static std::map<std::string, uint64_t> made; return made; }
FILE *record = nullptr;
std::string make_path(const char *name) {
  std::string path;
  for (const std::string &part : stack()) { if (!path.empty() && part[0] != '[') path += '.'; path += part; }
  if (*name) { if (!path.empty()) path += '.'; path += name; }
  return path;
}
uint64_t take(const std::string &path, int count) {
  auto found = known().find(path);
  if (found != known().end()) return found->second;
  uint64_t value = 0;
  for (int at = 0; at < count; ++at) { value <<= 8; if (left) { value |= *bytes++; --left; } }
  known()[path] = value;
  return value;
}
uint64_t keep(const std::string &path, uint64_t value) {
  if (record) { fprintf(record, "%s=%llu\n", path.c_str(), static_cast<unsigned long long>(value)); fflush(record); }
  return value;
}
}  // namespace

extern "C" {
void ri_enter(const char *name) noexcept { stack().push_back(name); }
void ri_enter_index(uint64_t index) noexcept { stack().push_back("[" + std::to_string(index) + "]"); }
void ri_leave(void) noexcept { stack().pop_back(); }
uint64_t ri_integer(const char *name, int bits, int is_signed) noexcept {
  std::string path = make_path(name);
  uint64_t value = keep(path, take(path, bits / 8));
  if (bits < 64 && is_signed && (value >> (bits - 1)) & 1) value |= ~((1ull << bits) - 1);
  return value;
}
uint64_t ri_boolean(const char *name) noexcept { std::string path = make_path(name); return keep(path, take(path, 1) & 1); }
double ri_float64(const char *name) noexcept { std::string path = make_path(name); uint64_t b = keep(path, take(path, 8)); double v; memcpy(&v, &b, 8); return v; }
float ri_float32(const char *name) noexcept { std::string path = make_path(name); uint32_t b = static_cast<uint32_t>(keep(path, take(path, 4))); float v; memcpy(&v, &b, 4); return v; }
uint64_t ri_size(const char *name, uint64_t most) noexcept { std::string path = make_path(name) + ".size"; return keep(path, take(path, 1) % (most + 1)); }
void ri_characters(const char *name, char *buffer, uint64_t most) noexcept {
  std::string path = make_path(name);
  for (uint64_t at = 0; at < most; ++at) { std::string one = path + "[" + std::to_string(at) + "]"; buffer[at] = static_cast<char>(keep(one, take(one, 1))); }
  buffer[most] = 0;
}
void ri_effect(const char *, const char *) noexcept {}
void ri_log(const char *) noexcept {}
void ri_sent_begin(const char *) noexcept {}
void ri_sent_integer(const char *, int, int, uint64_t) noexcept {}
void ri_sent_boolean(const char *, uint64_t) noexcept {}
void ri_sent_float64(const char *, double) noexcept {}
void ri_sent_float32(const char *, float) noexcept {}
void ri_sent_size(const char *, uint64_t) noexcept {}
void ri_sent_characters(const char *, const char *, uint64_t) noexcept {}
void ri_sent_end(void) noexcept {}
void ri_member(const char *, const void *, uint64_t) noexcept {}
void ri_begin(void) noexcept { begun = true; }
void ri_end(void) noexcept { longjmp(back, 1); }
void ri_unknown(const char *) noexcept { longjmp(back, 1); }
void ri_foreign(const char *) noexcept { longjmp(back, 1); }
void ri_cut(const char *) noexcept { if (begun) longjmp(back, 1); }
void ri_forget(const void *, uint64_t) noexcept {}
void ri_assume(int condition) noexcept { if (!condition) longjmp(back, 1); }

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  if (const char *path = getenv("RI_WITNESS")) record = fopen(path, "w");
  const char *wanted = getenv("RI_ENTRY");
  const RiEntry *entry = ri_entries;
  while (entry->name && wanted && strcmp(entry->name, wanted) != 0) ++entry;
  if (!entry->name) abort();
  bytes = data; left = size;
  stack().clear(); known().clear(); begun = false;
  ri_reset();
  // What is thrown before the callback begins is none of it.
  if (setjmp(back) == 0) entry->run();
  if (record) { fclose(record); record = nullptr; }
  return 0;
}
}
