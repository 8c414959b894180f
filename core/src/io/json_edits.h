// SPDX-License-Identifier: MIT
// Edits of a JSON text by place: what is not edited keeps its spelling, its order and its blanks.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "json_text.h"

namespace quadmark::io {

/// Collects edits of one JSON text that parseJson() has accepted, and applies all of them at once. Values and pieces
/// given to the calls must lie inside that text, which must outlive the object. An edit inside a member or element
/// that another edit removes or replaces makes apply() fail.
class JsonEdits {
 public:
  explicit JsonEdits(std::string_view text) : text_(text) {}

  /// Replaces a piece, normally a value or the inside of a string.
  void replace(std::string_view piece, std::string by);

  /// Gives an object's member a value: in place of the old one, or as a new last member.
  /// @param name, value  as they are to be spelled; the name without quotes.
  void setMember(JsonValue object, std::string_view name, std::string value);

  /// Removes a member with one of its commas; nothing if there is none of that name.
  void removeMember(JsonValue object, std::string_view name);

  void addElement(JsonValue array, std::string value);
  void removeElement(JsonValue array, std::size_t index);

  struct Applied {
    std::string text;
    std::uint64_t bytesChanged = 0;  ///< as countReplaced() has it, summed over the edits
  };

  /// The text with all edits. Fails with `internal` if edits overlap or the outcome is no JSON.
  [[nodiscard]] Result<Applied> apply() const;

 private:
  struct Replacement {
    std::size_t begin, end;
    std::string by;
  };
  /// Additions to an object or array and removals from it. They are gathered since commas depend on all of them.
  struct ContainerEdit {
    JsonValue container;
    std::set<std::size_t> removed;   // numbers of items
    std::vector<std::string> added;  // spelled in full
  };

  [[nodiscard]] std::size_t offsetOf(const char* place) const { return static_cast<std::size_t>(place - text_.data()); }
  ContainerEdit& editOf(JsonValue container);
  void spell(const ContainerEdit& edit, std::vector<Replacement>& replacements) const;

  std::string_view text_;
  std::vector<Replacement> replacements_;
  std::map<std::size_t, ContainerEdit> containers_;  // by the offset of the opening bracket
};

}  // namespace quadmark::io
