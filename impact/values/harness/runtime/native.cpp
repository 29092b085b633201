// Native replay: runs an entry for every witness of a file, each in a process of its own, and writes what was observed.
//
// Arguments: entry, file of witnesses, file of results, seconds for each. A file of witnesses holds lines `path=bits`
// (a number); a line `---` ends each. Results: lines of words, tabs between them; `case N` begins each one.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <signal.h>
#include <vector>

#include "rosimpact_values.h"

struct RiEntry { const char *name; void (*run)(); };
extern "C" const RiEntry ri_entries[];
extern "C" void __sanitizer_print_stack_trace() __attribute__((weak));

namespace {
using Values = std::map<std::string, unsigned long long>;
struct Member { const char *name; const unsigned char *start; std::string before; };
Values &values() { static Values made; return made; }
std::vector<std::string> &stack() { static std::vector<std::string> made; return made; }
std::vector<Member> &members() { static std::vector<Member> made; return made; }
int out = -1;

std::string make_path(const char *name) {
  std::string path;
  for (const std::string &part : stack()) {
    if (!path.empty() && part[0] != '[') path += '.';
    path += part;
  }
  if (*name) { if (!path.empty()) path += '.'; path += name; }
  return path;
}
unsigned long long get(const std::string &path) {
  auto found = values().find(path);
  return found == values().end() ? 0 : found->second;
}
std::string clean(const char *text) {
  std::string kept;
  for (; *text; ++text) kept += (*text == '\t' || *text == '\n') ? ' ' : *text;
  return kept;
}
void tell(const std::string &line) {
  if (out < 0) return;
  std::string whole = line + "\n";
  size_t done = 0;
  while (done < whole.size()) {
    ssize_t n = write(out, whole.data() + done, whole.size() - done);
    if (n <= 0) return;
    done += static_cast<size_t>(n);
  }
}
void tell_value(const char *name, const char *kind, int bits, int is_signed, unsigned long long value) {
  char rest[96];
  snprintf(rest, sizeof rest, "\t%s\t%d\t%d\t%llu", kind, bits, is_signed, value);
  tell("value\t" + make_path(name) + rest);
}
// Some instructions have no line, such as jumps back to where a loop begins; so it is looked at a few times.
void on_alarm(int) {
  static int looks = 0;
  if (looks++ == 0) tell("endless");
  if (__sanitizer_print_stack_trace) __sanitizer_print_stack_trace();
  if (looks > 3) _exit(79);
  ualarm(3000, 0);
}
}  // namespace

extern "C" {
void ri_enter(const char *name) noexcept { stack().push_back(name); }
void ri_enter_index(uint64_t index) noexcept { stack().push_back("[" + std::to_string(index) + "]"); }
void ri_leave(void) noexcept { stack().pop_back(); }
uint64_t ri_integer(const char *name, int bits, int is_signed) noexcept {
  uint64_t value = get(make_path(name));
  if (bits < 64) {
    value &= (1ull << bits) - 1;
    if (is_signed && (value >> (bits - 1)) & 1) value |= ~((1ull << bits) - 1);
  }
  return value;
}
uint64_t ri_boolean(const char *name) noexcept { return get(make_path(name)) & 1; }
double ri_float64(const char *name) noexcept { uint64_t bits = get(make_path(name)); double v; memcpy(&v, &bits, 8); return v; }
float ri_float32(const char *name) noexcept { uint32_t bits = static_cast<uint32_t>(get(make_path(name))); float v; memcpy(&v, &bits, 4); return v; }
uint64_t ri_size(const char *name, uint64_t most) noexcept { uint64_t v = get(make_path(name) + ".size"); return v > most ? most : v; }
void ri_characters(const char *name, char *buffer, uint64_t most) noexcept {
  std::string path = make_path(name);
  for (uint64_t at = 0; at < most; ++at) buffer[at] = static_cast<char>(get(path + "[" + std::to_string(at) + "]"));
  buffer[most] = 0;
}
void ri_effect(const char *kind, const char *name) noexcept { tell("effect\t" + clean(kind) + "\t" + clean(name)); }
void ri_log(const char *level) noexcept { tell("log\t" + clean(level)); }
void ri_sent_begin(const char *publisher) noexcept { tell("sent\t" + clean(publisher)); }
void ri_sent_integer(const char *name, int bits, int is_signed, uint64_t value) noexcept {
  tell_value(name, "integer", bits, is_signed, bits < 64 ? value & ((1ull << bits) - 1) : value);
}
void ri_sent_boolean(const char *name, uint64_t value) noexcept { tell_value(name, "boolean", 8, 0, value & 1); }
void ri_sent_float64(const char *name, double value) noexcept { uint64_t b; memcpy(&b, &value, 8); tell_value(name, "float64", 64, 1, b); }
void ri_sent_float32(const char *name, float value) noexcept { uint32_t b; memcpy(&b, &value, 4); tell_value(name, "float32", 32, 1, b); }
void ri_sent_size(const char *name, uint64_t value) noexcept {
  char rest[64];
  snprintf(rest, sizeof rest, ".size\tsize\t64\t0\t%llu", static_cast<unsigned long long>(value));
  tell("value\t" + make_path(name) + rest);
}
void ri_sent_characters(const char *name, const char *bytes, uint64_t size) noexcept {
  ri_sent_size(name, size);
  for (uint64_t at = 0; at < size && at < 64; ++at) {
    char rest[96];
    snprintf(rest, sizeof rest, "[%llu]\tcharacter\t8\t0\t%u", static_cast<unsigned long long>(at), static_cast<unsigned char>(bytes[at]));
    tell("value\t" + make_path(name) + rest);
  }
}
void ri_sent_end(void) noexcept { tell("sent end"); }
void ri_member(const char *name, const void *start, uint64_t size) noexcept {
  members().push_back({name, static_cast<const unsigned char *>(start), std::string(static_cast<const char *>(start), size)});
}
static bool has_begun = false;
void ri_begin(void) noexcept { has_begun = true; tell("begin"); }
void ri_end(void) noexcept {
  for (const Member &one : members())
    if (memcmp(one.start, one.before.data(), one.before.size()) != 0) ri_effect("member", one.name);
  tell("end");
  _exit(0);
}
void ri_unknown(const char *what) noexcept { tell("unknown\t" + clean(what)); _exit(77); }
void ri_foreign(const char *what) noexcept { ri_unknown(what); }
void ri_cut(const char *what) noexcept { if (has_begun) ri_unknown(what); }
void ri_forget(const void *, uint64_t) noexcept {}
void ri_assume(int condition) noexcept { if (!condition) { tell("impossible"); _exit(78); } }
}

int main(int argc, char **argv) {
  if (argc < 5) return 2;
  const RiEntry *entry = ri_entries;
  while (entry->name && strcmp(entry->name, argv[1]) != 0) ++entry;
  if (!entry->name) return 3;
  FILE *file = fopen(argv[2], "r");
  if (!file) return 4;
  int results = open(argv[3], O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (results < 0) return 5;
  unsigned seconds = static_cast<unsigned>(atoi(argv[4]));
  std::vector<Values> cases(1);
  char line[4096];
  while (fgets(line, sizeof line, file)) {
    line[strcspn(line, "\n")] = 0;
    if (strcmp(line, "---") == 0) { cases.emplace_back(); continue; }
    if (char *mark = strrchr(line, '=')) { *mark = 0; cases.back()[line] = strtoull(mark + 1, nullptr, 0); }
  }
  cases.pop_back();
  fclose(file);
  int null = open("/dev/null", O_RDWR);
  for (size_t at = 0; at < cases.size(); ++at) {
    std::string errors = std::string(argv[3]) + "." + std::to_string(at);
    pid_t child = fork();
    if (child < 0) return 6;
    if (child == 0) {
      out = results;
      tell("case\t" + std::to_string(at));
      int log = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      dup2(null, 0); dup2(null, 1); dup2(log, 2);
      values() = cases[at];
      signal(SIGALRM, on_alarm);
      alarm(seconds);
      entry->run();
      ri_end();
    }
    int status = 0;
    waitpid(child, &status, 0);
    out = results;
    tell("status\t" + std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)));
  }
  return 0;
}
