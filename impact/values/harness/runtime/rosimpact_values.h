// What a harness and a facade call. One set of functions, four back ends: the symbolic executor (impact/values/ir)
// takes them as its own; native replay, libFuzzer and KLEE link an implementation each.
//
// Paths: ri_enter("pose") / ri_enter_index(2) / ri_leave() keep a stack of names; a leaf's path is the stack's names
// joined by dots, indices in brackets, and its own name: msg.poses[2].position.x. A leaf whose name is "" is the top
// of the stack itself: msg.ranges[2].
#pragma once
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#define RI_NOEXCEPT noexcept
#else
#define RI_NOEXCEPT
#endif

void ri_enter(const char *name) RI_NOEXCEPT;
void ri_enter_index(uint64_t index) RI_NOEXCEPT;
void ri_leave(void) RI_NOEXCEPT;

// Inputs. Every call with the same path gives the same value.
uint64_t ri_integer(const char *name, int bits, int is_signed) RI_NOEXCEPT;  // sign-extended where is_signed
uint64_t ri_boolean(const char *name) RI_NOEXCEPT;                           // 0 or 1
double ri_float64(const char *name) RI_NOEXCEPT;
float ri_float32(const char *name) RI_NOEXCEPT;
uint64_t ri_size(const char *name, uint64_t most) RI_NOEXCEPT;               // 0..most; its path ends in .size
void ri_characters(const char *name, char *buffer, uint64_t most) RI_NOEXCEPT;  // most bytes <path>[i], then a NUL

// What others can observe. kind: publish service action parameter actuator reply transform shutdown.
void ri_effect(const char *kind, const char *name) RI_NOEXCEPT;
void ri_log(const char *level) RI_NOEXCEPT;

// The fields of a message that is published, between ri_sent_begin and ri_sent_end (paths by ri_enter, as above).
void ri_sent_begin(const char *publisher) RI_NOEXCEPT;
void ri_sent_integer(const char *name, int bits, int is_signed, uint64_t value) RI_NOEXCEPT;
void ri_sent_boolean(const char *name, uint64_t value) RI_NOEXCEPT;
void ri_sent_float64(const char *name, double value) RI_NOEXCEPT;
void ri_sent_float32(const char *name, float value) RI_NOEXCEPT;
void ri_sent_size(const char *name, uint64_t value) RI_NOEXCEPT;
void ri_sent_characters(const char *name, const char *bytes, uint64_t size) RI_NOEXCEPT;
void ri_sent_end(void) RI_NOEXCEPT;

// A member of the node: where it differs at the end of the callback, that is an effect `member` of this name.
void ri_member(const char *name, const void *start, uint64_t size) RI_NOEXCEPT;

// The bytes of a symbolic size without a fork: whether this build fills containers by their layout (the executor) or
// through their own functions (natively). Defined as a macro by the one who compiles: RI_SYMBOLIC.

// The callback begins: what was observable before (of main and constructors), and what was logged, does not count, and
// a crash before it is none of the callback's. Without a call, everything counts.
void ri_begin(void) RI_NOEXCEPT;
// The callback has returned: ends this way. What main does afterwards is none of it.
__attribute__((noreturn)) void ri_end(void) RI_NOEXCEPT;
// With RI_SYMBOLIC: of the block that begins at start (from operator new), only the first size bytes may be used from
// here on. A container that is filled by its layout has room for the most elements, and as many as its size says.
void ri_resize(void *start, uint64_t size) RI_NOEXCEPT;

// Nothing is known from here on: ends this way as unknown. Natively: ends the program with status 77.
void ri_unknown(const char *what) RI_NOEXCEPT;
// Something that is not known is done here, and the way goes on: it is not known to lead to nothing. Natively it ends, as
// with ri_unknown.
void ri_foreign(const char *what) RI_NOEXCEPT;
// A part of the code that stood here was left out. In the callback: as ri_unknown. Before it, the way goes on.
void ri_cut(const char *what) RI_NOEXCEPT;
// Some bytes (size 0: all of the object from there on) may be anything from here on; natively they stay as they are.
void ri_forget(const void *start, uint64_t size) RI_NOEXCEPT;
// This way cannot happen in a real node.
void ri_assume(int condition) RI_NOEXCEPT;

#ifdef __cplusplus
}
#endif
