#include "runtime/modbus/register_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/discovery.hpp"
#include "runtime/modbus/lock_file.hpp"
#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/errors.hpp"
#include "support/sha256.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::size_t index_of(Area area) {
  return static_cast<std::size_t>(area);
}

/// Addresses of an area that points may have; the discovery chain has the rest of the holding registers.
constexpr std::uint32_t size_of(Area area) {
  return area == Area::holding_register ? chain_address : 0x10000;
}

std::string text_of(const Stretch& at) {
  return at.count == 1 ? fmt::format("{} {}", name_of(at.area), at.address)
                       : fmt::format("{} {} to {}", name_of(at.area), at.address, at.address + at.count - 1);
}

/// Who has which address.
class Occupancy {
 public:
  struct Holder {
    std::string name;
    Place place;
  };

  /// The holder of the first address that is taken; none where the stretch is free.
  [[nodiscard]] const Holder* holder_of(const Stretch& at) const {
    const auto& taken = taken_[index_of(at.area)];
    auto next = taken.lower_bound(at.address);
    if (next != taken.end() && next->first < at.address + at.count) {
      return &next->second.second;
    }
    if (next != taken.begin()) {
      --next;
      if (next->first + next->second.first > at.address) {
        return &next->second.second;
      }
    }
    return nullptr;
  }

  void take(const Stretch& at, Holder holder) {
    taken_[index_of(at.area)].emplace(at.address, std::pair{at.count, std::move(holder)});
  }

 private:
  std::array<std::map<std::uint32_t, std::pair<std::uint32_t, Holder>>, 4> taken_;
};

class Placer {
 public:
  Placer(std::span<const Point> points, const MapRequest& request)
      : points_(points), request_(request), placed_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      index_.emplace(points[i].name, i);
    }
  }

  void place_given() {
    for (const GivenAddress& given : request_.given) {
      const auto point = index_.find(given.name);
      if (point == index_.end()) {
        diagnostics_.error(error::address_of_unknown_point, given.place,
                           fmt::format("The address {} is given to {}, which is no point.", given.address, given.name),
                           "name a pin, parameter or status of the running diagram, written as hysteron map lists it");
        continue;
      }
      if (const auto at = given_stretch(points_[point->second], given)) {
        take(point->second, *at, given.place);
      }
    }
  }

  void place_locked() {
    for (const LockLine& line : read_lock(request_.lock_file, request_.lock_text, diagnostics_)) {
      const auto point = index_.find(line.name);
      const bool stays = point != index_.end() && points_[point->second].type == line.type &&
                         fits(points_[point->second], line.at.area);
      if (stays && placed_[point->second]) {
        continue;  // an address given by hand replaces the one in the lock file
      }
      if (stays) {
        take(point->second, line.at, line.place);
      } else {
        retire(line);
      }
    }
  }

  /// Wide values first: so each is aligned, and no hole is left.
  void place_rest() {
    for (const std::uint32_t width : {4U, 2U, 1U}) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (!placed_[i] && registers_of(points_[i].type) == width) {
          place_freely(i, width);
        }
      }
    }
  }

  [[nodiscard]] const Diagnostics& diagnostics() const { return diagnostics_; }
  [[nodiscard]] std::vector<RetiredAddress> retired() const { return retired_; }

  [[nodiscard]] std::vector<MapEntry> entries() const {
    std::vector<MapEntry> list;
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      list.push_back({i, placed_[i].value_or(Stretch{})});
    }
    std::ranges::sort(list, {}, [](const MapEntry& entry) { return std::pair(entry.at.area, entry.at.address); });
    return list;
  }

 private:
  static bool fits(const Point& point, Area area) {
    return holds_bits(area) == (point.type == PointType::boolean) &&
           (!point.writable || area == Area::coil || area == Area::holding_register);
  }

  /// Keeps an address from being given anew. One that was given by hand is a point's, whoever had it before.
  void retire(const LockLine& line) {
    const auto* holder = occupancy_.holder_of(line.at);
    if (holder != nullptr && holder->place.file == request_.lock_file) {
      refuse_overlap(line.name, line.at, line.place, *holder);
    } else if (holder == nullptr) {
      occupancy_.take(line.at, {line.name + " (which is gone)", line.place});
      retired_.push_back({line.at, line.type, line.name});
    }
  }

  void refuse_overlap(const std::string& name, const Stretch& at, const Place& place, const Occupancy::Holder& holder) {
    diagnostics_.error(error::register_address_twice, place,
                       fmt::format("{} is given {}, which {} has.", name, text_of(at), holder.name),
                       "give one of them another address; a value of 32 bits takes two registers, one of 64 bits four",
                       {{holder.place, "the other"}});
  }

  void take(std::size_t point, const Stretch& at, const Place& place) {
    const std::string& name = points_[point].name;
    if (placed_[point]) {
      diagnostics_.error(error::point_addressed_twice, place, fmt::format("{} is given a second address.", name),
                         "give each point one address");
      return;
    }
    if (const auto* holder = occupancy_.holder_of(at)) {
      refuse_overlap(name, at, place, *holder);
      return;
    }
    occupancy_.take(at, {name, place});
    placed_[point] = at;
  }

  std::optional<Stretch> given_stretch(const Point& point, const GivenAddress& given) {
    const auto parsed = parse_address(given.address);
    if (!parsed) {
      diagnostics_.error(error::malformed_address, given.place, fmt::format("{} is no address.", given.address),
                         "write %QX0.0 to %QX99.7, %IX, %IW0 to %IW1023, %QW, %MW, %MD, %ML, or an area and a number: "
                         "holding 16, input 3, coil 0, discrete 7");
      return std::nullopt;
    }
    Stretch at = parsed->at;
    const auto width = static_cast<std::uint32_t>(registers_of(point.type));
    if (!fits(point, at.area) || (!parsed->any_width && at.count != width)) {
      diagnostics_.error(
          error::unfit_address, given.place,
          fmt::format("{} is {}{} and does not fit {}.", point.name, point.writable ? "a writable " : "a ",
                      name_of(point.type), given.address),
          "booleans fit coil and discrete (%QX, %IX), 16 bits %IW, %QW and %MW, 32 bits %MD, 64 bits %ML; what may be "
          "written fits coil and holding alone");
      return std::nullopt;
    }
    at.count = width;
    if (at.address + at.count > size_of(at.area)) {
      diagnostics_.error(error::no_address_left, given.place,
                         fmt::format("{} would end at {}, behind the last address of its area.", point.name,
                                     text_of({at.area, at.address + at.count - 1, 1})),
                         fmt::format("stay below {}", size_of(at.area)));
      return std::nullopt;
    }
    return at;
  }

  [[nodiscard]] std::vector<Stretch> ranges_for(const Point& point, std::uint32_t width) const {
    const bool boolean = point.type == PointType::boolean;
    if (request_.placing == Placing::compact) {
      const Area area = boolean ? (point.writable ? Area::coil : Area::discrete_input)
                                : (point.writable ? Area::holding_register : Area::input_register);
      return {{area, 0, size_of(area)}};
    }
    if (boolean) {
      return {point.writable ? openplc::output_bits : openplc::input_bits};
    }
    if (width == 1) {
      return point.writable ? std::vector{openplc::output_words, openplc::memory_words}
                            : std::vector{openplc::input_words};
    }
    return {width == 2 ? openplc::memory_doubles : openplc::memory_longs};
  }

  void place_freely(std::size_t point, std::uint32_t width) {
    for (const Stretch& range : ranges_for(points_[point], width)) {
      for (std::uint32_t at = range.address; at + width <= range.address + range.count; at += width) {
        const Stretch here{range.area, at, width};
        if (occupancy_.holder_of(here) == nullptr) {
          occupancy_.take(here, {points_[point].name, {}});
          placed_[point] = here;
          return;
        }
      }
    }
    diagnostics_.error(error::no_address_left, {.file = request_.lock_file},
                       fmt::format("No address is left for {}.", points_[point].name),
                       "remove addresses of points that are gone from the lock file, or expose fewer points");
  }

  std::span<const Point> points_;
  const MapRequest& request_;
  std::map<std::string, std::size_t, std::less<>> index_;
  std::vector<std::optional<Stretch>> placed_;
  std::vector<RetiredAddress> retired_;
  Occupancy occupancy_;
  Diagnostics diagnostics_;
};

}  // namespace

std::span<const MapEntry> RegisterMap::entries_in(Area area) const {
  const std::size_t i = index_of(area);
  return std::span(entries_).subspan(first_[i], first_[i + 1] - first_[i]);
}

const MapEntry* RegisterMap::find(Area area, std::uint32_t address) const {
  const auto list = entries_in(area);
  const auto after =
      std::ranges::upper_bound(list, address, {}, [](const MapEntry& entry) { return entry.at.address; });
  if (after == list.begin()) {
    return nullptr;
  }
  const MapEntry& entry = *(after - 1);
  return address < entry.at.address + entry.at.count ? &entry : nullptr;
}

RegisterMap make_register_map(std::span<const Point> points, const MapRequest& request) {
  Placer placer(points, request);
  placer.place_given();
  placer.place_locked();
  placer.place_rest();
  if (placer.diagnostics().has_errors()) {
    throw InputError(placer.diagnostics());
  }
  RegisterMap map;
  map.title_ = request.title;
  map.points_.assign(points.begin(), points.end());
  map.order_ = request.order;
  map.entries_ = placer.entries();
  map.retired_ = placer.retired();
  for (const Area area : areas) {
    map.first_[index_of(area)] = static_cast<std::size_t>(
        std::ranges::lower_bound(map.entries_, area, {}, [](const MapEntry& entry) { return entry.at.area; }) -
        map.entries_.begin());
  }
  map.first_[4] = map.entries_.size();
  map.hash_ = sha256(fmt::format("{}\n{}", name_of(map.order_), as_csv(map)));
  map.chain_ = make_chain(map);
  if (chain_address + map.chain_.size() > 0x10000) {
    throw InputError(error::no_address_left, {.file = request.lock_file},
                     fmt::format("{} points do not fit the discovery chain.", points.size()), "expose fewer points");
  }
  return map;
}

}  // namespace hysteron::runtime::modbus
