#include <cassert>
#include <cstdint>
#include <string>

uint32_t checksum(const std::string & line)
{
  assert(!line.empty());
  uint32_t sum = 0;
  for (char c : line) {
    sum ^= static_cast<uint32_t>(c);
  }
  return sum;
}
