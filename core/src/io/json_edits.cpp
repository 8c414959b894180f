// SPDX-License-Identifier: MIT
#include "json_edits.h"

#include <algorithm>

#include "allowed_spans.h"

namespace quadmark::io {
namespace {

/// Where the items of an object or array lie, members from the quote of their key to the end of their value.
std::vector<std::string_view> itemsOf(JsonValue container) {
  std::vector<std::string_view> items;
  container.forEachElement([&](JsonValue value) { items.push_back(value.text()); });
  container.forEachMember([&](std::string_view key, JsonValue value) {
    const char* begin = key.data() - 1;
    items.emplace_back(begin, static_cast<std::size_t>(value.text().data() + value.text().size() - begin));
  });
  return items;
}

}  // namespace

void JsonEdits::replace(std::string_view piece, std::string by) {
  const std::size_t begin = offsetOf(piece.data());
  replacements_.push_back(Replacement{begin, begin + piece.size(), std::move(by)});
}

JsonEdits::ContainerEdit& JsonEdits::editOf(JsonValue container) {
  ContainerEdit& edit = containers_[offsetOf(container.text().data())];
  edit.container = container;
  return edit;
}

void JsonEdits::setMember(JsonValue object, std::string_view name, std::string value) {
  if (const JsonValue old = object.find(name)) {
    replace(old.text(), std::move(value));
  } else {
    std::string member = "\"";
    editOf(object).added.push_back(member.append(name).append("\":").append(value));
  }
}

void JsonEdits::removeMember(JsonValue object, std::string_view name) {
  std::size_t index = 0;
  object.forEachMember([&](std::string_view key, JsonValue) {
    if (keyIs(key, name)) editOf(object).removed.insert(index);  // a repeated one too, or it would come to life
    ++index;
  });
}

void JsonEdits::addElement(JsonValue array, std::string value) {
  editOf(array).added.push_back(std::move(value));
}

void JsonEdits::removeElement(JsonValue array, std::size_t index) {
  editOf(array).removed.insert(index);
}

void JsonEdits::spell(const ContainerEdit& edit, std::vector<Replacement>& replacements) const {
  const std::vector<std::string_view> items = itemsOf(edit.container);
  const auto begin = [&](std::size_t i) { return offsetOf(items[i].data()); };
  const auto end = [&](std::size_t i) { return begin(i) + items[i].size(); };

  // Behind a kept item its comma goes with the removed one, else the comma after it.
  bool anyKept = false;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (edit.removed.count(i) == 0) {
      anyKept = true;
    } else if (anyKept) {
      replacements.push_back(Replacement{end(i - 1), end(i), {}});
    } else {
      replacements.push_back(Replacement{begin(i), i + 1 < items.size() ? begin(i + 1) : end(i), {}});
    }
  }
  if (edit.added.empty()) return;
  std::string text;
  for (const std::string& item : edit.added) text += (anyKept || !text.empty() ? "," : "") + item;
  const std::size_t at = items.empty() ? offsetOf(edit.container.text().data()) + 1 : end(items.size() - 1);
  replacements.push_back(Replacement{at, at, std::move(text)});
}

Result<JsonEdits::Applied> JsonEdits::apply() const {
  std::vector<Replacement> all = replacements_;
  for (const auto& entry : containers_) spell(entry.second, all);
  // An insertion comes behind a replacement that ends where it begins; several at one place keep their order.
  std::multimap<std::pair<std::size_t, std::size_t>, const Replacement*> byPlace;
  for (const Replacement& edit : all) byPlace.emplace(std::pair(edit.begin, edit.end), &edit);
  Applied applied;
  std::size_t copied = 0;
  for (const auto& entry : byPlace) {
    const Replacement& edit = *entry.second;
    if (edit.begin < copied || edit.end > text_.size()) {
      return Error{ErrorCode::internal, "self-check: text edits overlap"};
    }
    applied.text += text_.substr(copied, edit.begin - copied);
    applied.text += edit.by;
    copied = edit.end;
    applied.bytesChanged += countReplaced(text_.substr(edit.begin, edit.end - edit.begin), edit.by);
  }
  applied.text += text_.substr(copied);
  if (!parseJson(applied.text)) return Error{ErrorCode::internal, "self-check: the edited JSON is broken"};
  return applied;
}

}  // namespace quadmark::io
