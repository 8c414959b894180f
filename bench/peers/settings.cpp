// SPDX-License-Identifier: MIT
#include "settings.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace quadmark::bench {
namespace {

std::string shortNumber(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

Result<std::vector<double>> settingValues(const std::string& text, const std::vector<Setting>& known) {
  std::vector<double> values;
  for (const Setting& setting : known) values.push_back(setting.usual);
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::string name = part.substr(0, part.find('='));
    const auto found = std::find_if(known.begin(), known.end(), [&](const Setting& s) { return s.name == name; });
    if (found == known.end())
      return Error{ErrorCode::badOption, "setting '" + name + "' is unknown; there are: " + describe(known)};
    const char* number = name.size() == part.size() ? "" : part.c_str() + name.size() + 1;
    char* end = nullptr;
    const double value = std::strtod(number, &end);
    if (end == number || *end != '\0' || !(value >= found->low && value <= found->high))
      return Error{ErrorCode::badOption, "setting '" + part + "' is not in its range: " + describe({*found})};
    values[static_cast<std::size_t>(found - known.begin())] = value;
  }
  return values;
}

std::string usualText(const std::vector<Setting>& known) {
  std::string out;
  for (const Setting& setting : known) out += (out.empty() ? "" : ",") + setting.name + '=' + shortNumber(setting.usual);
  return out;
}

std::string describe(const std::vector<Setting>& known) {
  if (known.empty()) return "none";
  std::string out;
  for (const Setting& setting : known) {
    out += (out.empty() ? "" : "; ") + setting.name + ' ' + shortNumber(setting.low) + " .. " +
           shortNumber(setting.high) + ", usually " + shortNumber(setting.usual);
  }
  return out;
}

}  // namespace quadmark::bench
