// SPDX-License-Identifier: MIT
#include "robust_results.h"

#include <cstdio>
#include <fstream>
#include <utility>

namespace quadmark::bench {
namespace {

std::string joined(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line.append(field).push_back(';');
  return line;
}

}  // namespace

ResultFile::ResultFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  std::ifstream stream(path_);
  for (std::string line; std::getline(stream, line);)
    for (std::size_t i = 0; i < line.size(); ++i)
      if (line[i] == ';') keys_.insert(line.substr(0, i + 1));
}

bool ResultFile::has(const std::vector<std::string>& key) const {
  return keys_.count(joined(key)) == 1;
}

void ResultFile::add(const std::vector<std::string>& key, const std::vector<std::string>& values) {
  const std::string begin = joined(key), line = begin + joined(values) + "\n";
  keys_.insert(begin);
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
  if (path_.empty()) return;
  if (std::FILE* file = std::fopen(path_.c_str(), "ab")) {
    std::fputs(line.c_str(), file);  // one write of less than a page
    std::fclose(file);
  }
}

}  // namespace quadmark::bench
