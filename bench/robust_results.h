// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <vector>

namespace quadmark::bench {

/// A file of lines "field;field;...", each appended whole, so that several processes can share it and a run that was
/// interrupted goes on where it stopped.
class ResultFile {
 public:
  /// Reads what is there. An empty path keeps nothing.
  explicit ResultFile(std::string path);

  /// Whether a line begins with these fields.
  [[nodiscard]] bool has(const std::vector<std::string>& key) const;
  /// Appends a line of the key's fields and these; prints it, too.
  void add(const std::vector<std::string>& key, const std::vector<std::string>& values);

 private:
  std::string path_;
  std::set<std::string> keys_;  ///< every proper prefix of a line
};

}  // namespace quadmark::bench
