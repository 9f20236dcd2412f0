#pragma once
#include <algorithm>
#include <cctype>
#include <string>

namespace silt {

/// Names of options are known in lower case, whatever the user wrote; so are the words that become part of them.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace silt
