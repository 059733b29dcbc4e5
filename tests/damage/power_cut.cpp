// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "recorded_disk.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace cayspin::test {
namespace {

constexpr std::size_t sector = 512;

void put(std::string& content, std::size_t offset, char const* bytes, std::size_t count) {
  if (content.size() < offset + count) content.resize(offset + count, '\0');
  content.replace(offset, count, bytes, count);
}

// A file of which a power cut may leave only part. Events up to the last sync are sure to be on the
// disk.
class CutFile {
 public:
  void add(DiskEvent const& event) {
    if (event.kind == DiskEvent::write || event.kind == DiskEvent::resize) open_.push_back(&event);
    if (event.kind != DiskEvent::sync) return;
    for (auto const* const done : open_)
      if (done->kind == DiskEvent::write)
        put(content_, done->offset, done->bytes.data(), done->bytes.size());
      else
        content_.resize(done->offset, '\0');
    content_.resize(event.offset, '\0');
    open_.clear();
  }

  std::string cut(Choose const& choose, Choose const& choose_order) {
    std::set<std::size_t> sizes{content_.size()};
    auto size = content_.size();
    for (auto const* const event : open_) {
      size = event->kind == DiskEvent::resize
                 ? event->offset
                 : std::max(size, static_cast<std::size_t>(event->offset) + event->bytes.size());
      sizes.insert(size);
    }
    for (std::size_t left = open_.size(); left > 1; --left)
      std::swap(open_[left - 1], open_[choose_order(left)]);
    for (auto const* const event : open_)
      if (event->kind == DiskEvent::write) write_torn(*event, choose);
    auto chosen = sizes.begin();
    if (sizes.size() > 1) std::advance(chosen, choose(sizes.size()));
    content_.resize(*chosen, '\0');
    return content_;
  }

 private:
  void write_torn(DiskEvent const& event, Choose const& choose) {
    for (std::size_t begin = 0; begin < event.bytes.size();) {
      auto const count =
          std::min(event.bytes.size() - begin, sector - (event.offset + begin) % sector);
      if (choose(2) == 1) put(content_, event.offset + begin, &event.bytes[begin], count);
      begin += count;
    }
  }

  std::string content_;
  std::vector<DiskEvent const*> open_;
};

using Names = std::map<std::string, std::size_t>;

void apply(DiskEvent const& event, Names& names) {
  if (event.kind == DiskEvent::create) names[event.name] = event.file;
  if (event.kind == DiskEvent::unlink) names.erase(event.name);
  if (event.kind != DiskEvent::rename || !names.contains(event.name)) return;
  names[event.new_name] = names.at(event.name);
  names.erase(event.name);
}

Names names_after(std::vector<DiskEvent> const& events, std::size_t cut, Choose const& choose) {
  Names names;
  std::vector<DiskEvent const*> open;
  for (std::size_t i = 0; i < cut; ++i) {
    auto const kind = events[i].kind;
    if (kind == DiskEvent::create || kind == DiskEvent::rename || kind == DiskEvent::unlink)
      open.push_back(&events[i]);
    if (kind != DiskEvent::sync_folder) continue;
    for (auto const* const event : open) apply(*event, names);
    open.clear();
  }
  for (auto const* const event : open)
    if (choose(2) == 1) apply(*event, names);
  return names;
}

}  // namespace

DiskState after_power_cut(std::vector<DiskEvent> const& events, std::size_t cut,
                          Choose const& choose, Choose const& choose_order) {
  std::map<std::size_t, CutFile> files;
  for (std::size_t i = 0; i < cut; ++i)
    if (events[i].kind <= DiskEvent::sync) files[events[i].file].add(events[i]);
  DiskState state;
  for (auto const& [name, file] : names_after(events, cut, choose))
    state[name] = files[file].cut(choose, choose_order);
  return state;
}

}  // namespace cayspin::test
