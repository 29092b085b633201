// KLEE: every input is made symbolic by its path. A way that ends is reported by its reaction: testN.handled.err,
// testN.log.err, testN.ignored.err, each with the message that takes it.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <klee/klee.h>
#include "rosimpact_values.h"

static int ri_effects, ri_logs;
static struct { const void *place; void *before; uint64_t size; } ri_members[64];
static unsigned ri_watched;
static char ri_path[512]; static unsigned ri_lengths[64]; static unsigned ri_depth;
static void ri_push(const char *text, int dot) {
  unsigned size = strlen(ri_path);
  if (ri_depth < 64) ri_lengths[ri_depth++] = size;
  if (dot && size && size < 510) ri_path[size++] = '.';
  for (; *text && size < 510; ++text) ri_path[size++] = *text;
  ri_path[size] = 0;
}
static const char *ri_name(const char *name) {
  static char whole[640]; unsigned size = strlen(ri_path);
  memcpy(whole, ri_path, size);
  if (*name && size) whole[size++] = '.';
  for (; *name && size < 630; ++name) whole[size++] = *name;
  whole[size] = 0;
  return whole;
}
static void ri_digits(uint64_t value, char *into) { char back[24]; unsigned n = 0; do { back[n++] = (char)('0' + value % 10); value /= 10; } while (value); while (n) *into++ = back[--n]; *into = 0; }

extern "C" {
void ri_enter(const char *name) noexcept { ri_push(name, 1); }
void ri_enter_index(uint64_t index) noexcept { char text[32] = "["; ri_digits(index, text + 1); unsigned n = strlen(text); text[n] = ']'; text[n + 1] = 0; ri_push(text, 0); }
void ri_leave(void) noexcept { if (ri_depth) ri_path[ri_lengths[--ri_depth]] = 0; }
uint64_t ri_integer(const char *name, int bits, int is_signed) noexcept {
#define RI_ONE(B, S, U) if (bits == B) { U v; klee_make_symbolic(&v, sizeof v, ri_name(name)); return is_signed ? (uint64_t)(int64_t)(S)v : v; }
  RI_ONE(8, int8_t, uint8_t) RI_ONE(16, int16_t, uint16_t) RI_ONE(32, int32_t, uint32_t) RI_ONE(64, int64_t, uint64_t)
  return 0;
}
uint64_t ri_boolean(const char *name) noexcept { uint8_t v; klee_make_symbolic(&v, 1, ri_name(name)); return v & 1; }
double ri_float64(const char *name) noexcept { double v; klee_make_symbolic(&v, sizeof v, ri_name(name)); return v; }
float ri_float32(const char *name) noexcept { float v; klee_make_symbolic(&v, sizeof v, ri_name(name)); return v; }
uint64_t ri_size(const char *name, uint64_t most) noexcept {
  char whole[680]; strcpy(whole, ri_name(name)); strcat(whole, ".size");
  uint64_t v; klee_make_symbolic(&v, sizeof v, whole); klee_assume(v <= most);
  // A way for each size: KLEE ends ways on which memory of a symbolic size is asked for.
  for (uint64_t one = 0; one < most; ++one) if (v == one) return one;
  return most;
}
void ri_characters(const char *name, char *buffer, uint64_t most) noexcept { klee_make_symbolic(buffer, most + 1, ri_name(name)); klee_assume(buffer[most] == 0); }
void ri_effect(const char *, const char *) noexcept { ++ri_effects; }
void ri_log(const char *) noexcept { ++ri_logs; }
void ri_sent_begin(const char *) noexcept {}
void ri_sent_integer(const char *, int, int, uint64_t) noexcept {}
void ri_sent_boolean(const char *, uint64_t) noexcept {}
void ri_sent_float64(const char *, double) noexcept {}
void ri_sent_float32(const char *, float) noexcept {}
void ri_sent_size(const char *, uint64_t) noexcept {}
void ri_sent_characters(const char *, const char *, uint64_t) noexcept {}
void ri_sent_end(void) noexcept {}
void ri_member(const char *, const void *place, uint64_t size) noexcept {
  if (ri_watched == 64) return;
  ri_members[ri_watched] = {place, malloc(size), size};
  memcpy(ri_members[ri_watched++].before, place, size);
}
static bool ri_begun = false;
void ri_begin(void) noexcept {
  ri_begun = true;
  ri_effects = ri_logs = 0;
}
void ri_end(void) noexcept {
  for (unsigned i = 0; i < ri_watched; ++i)
    if (memcmp(ri_members[i].place, ri_members[i].before, ri_members[i].size)) ++ri_effects;
  if (ri_effects) klee_report_error(__FILE__, __LINE__, "handled", "handled.err");
  if (ri_logs) klee_report_error(__FILE__, __LINE__, "log-only", "log.err");
  klee_report_error(__FILE__, __LINE__, "ignored", "ignored.err");
}
void ri_unknown(const char *what) noexcept { klee_warning_once(what); klee_silent_exit(77); }
void ri_foreign(const char *what) noexcept { ri_unknown(what); }
void ri_cut(const char *what) noexcept { if (ri_begun) ri_unknown(what); }
void ri_forget(const void *, uint64_t) noexcept {}
void ri_assume(int condition) noexcept { klee_assume(condition); }
void RI_KLEE_ENTRY(void);
}

// What libstdc++ does where KLEE has no library of it.
namespace std {
void __throw_out_of_range(const char *) { klee_report_error(__FILE__, __LINE__, "std::out_of_range", "exception.err"); }
void __throw_out_of_range_fmt(const char *, ...) { klee_report_error(__FILE__, __LINE__, "std::out_of_range", "exception.err"); }
void __throw_invalid_argument(const char *) { klee_report_error(__FILE__, __LINE__, "std::invalid_argument", "exception.err"); }
void __throw_length_error(const char *) { klee_report_error(__FILE__, __LINE__, "std::length_error", "exception.err"); }
void __throw_logic_error(const char *) { klee_report_error(__FILE__, __LINE__, "std::logic_error", "exception.err"); }
void __throw_bad_alloc() { klee_report_error(__FILE__, __LINE__, "std::bad_alloc", "exception.err"); }
void __throw_bad_function_call() { klee_report_error(__FILE__, __LINE__, "std::bad_function_call", "exception.err"); }
}  // namespace std
extern "C" void ri_assertion_failed(const char *, int, const char *, const char *) __asm__("_ZSt21__glibcxx_assert_failPKciS0_S0_");
extern "C" void ri_assertion_failed(const char *, int, const char *, const char *) { klee_report_error(__FILE__, __LINE__, "an assertion of libstdc++", "assert.err"); }

int main() { RI_KLEE_ENTRY(); return 0; }
