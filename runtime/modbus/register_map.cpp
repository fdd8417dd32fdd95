#include "runtime/modbus/register_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/discovery.hpp"
#include "runtime/modbus/lock_file.hpp"
#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/errors.hpp"
#include "support/name_index.hpp"
#include "support/sha256.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::size_t index_of(Area area) {
  return static_cast<std::size_t>(area);
}

constexpr std::uint32_t area_size = 0x10000;

std::string text_of(const Stretch& at) {
  return at.count == 1 ? address_text(at) : fmt::format("{} to {}", address_text(at), at.address + at.count - 1);
}

/// Who has which address. Bits of one register stand beside one another, sixteen to an address.
class Occupancy {
 public:
  struct Holder {
    std::string name;
    Place place;
  };

  /// The holder of the first address that is taken; none where the stretch is free.
  [[nodiscard]] const Holder* holder_of(const Stretch& at) const {
    const auto& taken = taken_[index_of(at.area)];
    const auto [begin, end] = sixteenths(at);
    auto next = taken.lower_bound(begin);
    if (next != taken.end() && next->first < end) {
      return &next->second.second;
    }
    if (next != taken.begin()) {
      --next;
      if (next->second.first > begin) {
        return &next->second.second;
      }
    }
    return nullptr;
  }

  void take(const Stretch& at, Holder holder) {
    const auto [begin, end] = sixteenths(at);
    taken_[index_of(at.area)].emplace(begin, std::pair{end, std::move(holder)});
  }

 private:
  static std::pair<std::uint32_t, std::uint32_t> sixteenths(const Stretch& at) {
    const std::uint32_t begin = 16 * at.address + at.shift();
    return {begin, at.is_bit() ? begin + 1 : begin + 16 * at.count};
  }

  std::array<std::map<std::uint32_t, std::pair<std::uint32_t, Holder>>, 4> taken_;
};

class Placer {
 public:
  Placer(std::span<const Point> points, const MapRequest& request)
      : points_(points), request_(request), placed_(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      index_.emplace(points[i].name, i);
      formats_.push_back({.type = points[i].type, .order = request.order});
    }
    is_exposed_.resize(points.size(), request.expose.empty());
    is_flawed_.resize(points.size(), false);
  }

  void choose_exposed() {
    for (const std::string& wanted : request_.expose) {
      const bool is_prefix = wanted.ends_with('*');
      const std::string_view begin = std::string_view(wanted).substr(0, wanted.size() - (is_prefix ? 1 : 0));
      bool is_known = false;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const bool is_meant = is_prefix ? points_[i].name.starts_with(begin) : points_[i].name == begin;
        is_exposed_[i] = is_exposed_[i] || is_meant;
        is_known = is_known || is_meant;
      }
      if (!is_known) {
        diagnostics_.error(
            error::unknown_exposed_point, request_.expose_place,
            fmt::format("expose names {}, which is no point.", wanted),
            "name pins, parameters or status values as hysteron map lists them without expose; a star at "
            "the end stands for any rest");
      }
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      is_exposed_[i] = is_exposed_[i] && index_.at(points_[i].name) == i;
    }
  }

  void place_given() {
    std::vector<std::pair<const GivenRegister*, std::size_t>> known;
    for (const GivenRegister& given : request_.given) {
      const auto point = index_.find(given.name);
      if (point == index_.end()) {
        diagnostics_.error(error::address_of_unknown_point, given.place,
                           fmt::format("{} is given to {}, which is no point.",
                                       given.address.empty() ? "A format" : "The address " + given.address, given.name),
                           "name a pin, parameter or status of the running diagram, written as hysteron map lists it");
        continue;
      }
      if (!is_exposed_[point->second]) {
        diagnostics_.error(error::address_of_unknown_point, given.place,
                           fmt::format("{} has a place on the map, and expose does not name it.", given.name),
                           "add it to expose, or remove its place");
        continue;
      }
      if (given.format && !set_format(point->second, given)) {
        is_flawed_[point->second] = true;
        continue;
      }
      known.emplace_back(&given, point->second);
    }
    for (const auto& [given, point] : known) {            // the width of each is known now
      if (given->address.empty() || is_flawed_[point]) {  // how wide the flawed one would be is not known
        continue;
      }
      if (const auto at = given_stretch(point, *given)) {
        take(point, *at, given->place);
      }
    }
  }

  void place_locked() {
    const std::uint32_t holding_end = size_of(Area::holding_register);
    const auto by_hand = placed_;
    const auto lines = read_lock(request_.lock_file, request_.lock_text, holding_end, diagnostics_);
    const NameIndex alike = names_without_line(lines);
    for (const LockLine& line : lines) {
      auto point = index_.find(line.name);
      if (const std::uint32_t* const renamed = alike.find(line.name); point == index_.end() && renamed != nullptr) {
        point = index_.find(points_[*renamed].name);
      }
      if (point != index_.end() && is_flawed_[point->second]) {
        continue;
      }
      const bool stays = point != index_.end() && is_exposed_[point->second] &&
                         formats_[point->second].type == line.type && fits(point->second, line.at);
      if (stays && by_hand[point->second]) {
        continue;  // an address given by hand replaces the one in the lock file
      }
      if (stays && !placed_[point->second]) {
        take(point->second, line.at, line.place);
      } else {
        retire(line);
      }
    }
  }

  /// Wide values first: so each is aligned, and no hole is left. But what comes last comes last.
  void place_rest() {
    for (const bool comes_last : {false, true}) {
      for (const std::uint32_t width : {4U, 2U, 1U}) {
        for (std::size_t i = 0; i < points_.size(); ++i) {
          const bool is_now = points_[i].comes_last == comes_last && registers_of(formats_[i].type) == width;
          if (is_exposed_[i] && !placed_[i] && !is_flawed_[i] && is_now) {
            place_freely(i, width);
          }
        }
      }
    }
  }

  [[nodiscard]] const Diagnostics& diagnostics() const { return diagnostics_; }
  [[nodiscard]] std::vector<RetiredAddress> retired() const { return retired_; }

  [[nodiscard]] std::vector<MapEntry> entries() const {
    std::vector<MapEntry> list;
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      if (placed_[i]) {
        list.push_back({i, *placed_[i], formats_[i]});
      }
    }
    std::ranges::sort(list, {},
                      [](const MapEntry& entry) { return std::tuple(entry.at.area, entry.at.address, entry.at.bit); });
    return list;
  }

 private:
  /// Addresses of an area that points may have; the discovery chain has the rest of the holding registers.
  [[nodiscard]] std::uint32_t size_of(Area area) const {
    return area == Area::holding_register && request_.has_discovery ? chain_address : area_size;
  }

  [[nodiscard]] bool fits(std::size_t point, const Stretch& at) const {
    return at.is_boolean() == (formats_[point].type == PointType::boolean) &&
           (!points_[point].writable || at.area == Area::coil || at.area == Area::holding_register);
  }

  /// Points that no line names as they are written now: a line that differs in case alone may be theirs.
  [[nodiscard]] NameIndex names_without_line(const std::vector<LockLine>& lines) const {
    std::vector<bool> is_named(points_.size(), false);
    for (const LockLine& line : lines) {
      if (const auto point = index_.find(line.name); point != index_.end()) {
        is_named[point->second] = true;
      }
    }
    NameIndex names;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!is_named[i]) {
        names.add(points_[i].name, static_cast<std::uint32_t>(i));
      }
    }
    return names;
  }

  /// False where the format does not serve.
  bool set_format(std::size_t point, const GivenRegister& given) {
    const PointFormat format = given.format->or_else(points_[point].type, request_.order);
    std::string flaw = flaw_of(format);
    if (format.type == PointType::boolean && points_[point].type != PointType::boolean) {
      flaw = fmt::format("is a {}, which no boolean holds", name_of(points_[point].type));
    }
    if (std::string of_order = order_flaw_of(*given.format, format.type); !of_order.empty()) {
      flaw = std::move(of_order);
    }
    if (!flaw.empty()) {
      diagnostics_.error(
          error::unfit_format, given.place, fmt::format("{} {}.", given.name, flaw),
          "choose a type, a scale and an offset in which each value of the point is near a step; leave out "
          "what does not apply");
      return false;
    }
    formats_[point] = format;
    warn_of_range(points_[point], format, given.place);
    return true;
  }

  /// What the type does not reach is read as the nearest that it does: nobody shall find that out at the machine.
  void warn_of_range(const Point& point, const PointFormat& format, const Place& place) {
    const std::string flaw = range_flaw_of(format, point.low, point.high);
    if (!flaw.empty()) {
      diagnostics_.warning(error::unfit_format, place, fmt::format("{} {}.", point.name, flaw),
                           point.writable ? "choose a wider type or another scale, or narrow the range in the diagram."
                                          : "choose a wider type or another scale; clients read a value beyond it as "
                                            "the nearest that the type has.");
    }
  }

  /// Keeps an address from being given anew. One that was given by hand is a point's, whoever had it before.
  void retire(const LockLine& line) {
    const auto* holder = occupancy_.holder_of(line.at);
    if (holder != nullptr && holder->place.file == request_.lock_file) {
      refuse_overlap(line.name, line.at, line.place, *holder);
    } else if (holder == nullptr) {
      occupancy_.take(
          line.at, {line.name + (index_.contains(line.name) ? " (which was there)" : " (which is gone)"), line.place});
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

  /// What may be written instead: beside what was meant, if that can be told.
  static std::string fitting_address(bool is_writable, RegisterType type, const Stretch& at) {
    const Area registers =
        is_writable || at.area == Area::holding_register ? Area::holding_register : Area::input_register;
    const Area bits = is_writable || at.area == Area::coil ? Area::coil : Area::discrete_input;
    if (type == PointType::boolean) {
      const unsigned bit = at.is_bit() ? at.shift() : 0U;
      return holds_bits(at.area)
                 ? fmt::format("write {} {}, which may be written.", name_of(bits), at.address)
                 : fmt::format("write a bit of the register, {} {}.{} (0 is the lowest, 15 the highest), or {} {}.",
                               name_of(registers), at.address, bit, name_of(bits), at.address);
    }
    const std::size_t width = registers_of(type);
    return fmt::format("write {} {}; it takes {} from there on{}.", name_of(registers), at.address,
                       width == 1 ? "one register" : fmt::format("{} registers", width),
                       width == 1   ? ""
                       : width == 2 ? ", as %MD0 and its like do"
                                    : ", as %ML0 and its like do");
  }

  std::optional<Stretch> given_stretch(std::size_t index, const GivenRegister& given) {
    const Point& point = points_[index];
    const RegisterType type = formats_[index].type;
    const auto parsed = parse_address(given.address);
    if (!parsed) {
      diagnostics_.error(error::malformed_address, given.address_place, fmt::format("{} is no address.", given.address),
                         "write %QX0.0 to %QX99.7, %IX, %IW0 to %IW1023, %QW, %MW, %MD, %ML, or an area and a number: "
                         "holding 16, input 3, coil 0, discrete 7; of a bit in a register: holding 16.3");
      return std::nullopt;
    }
    Stretch at = parsed->at;
    const auto width = static_cast<std::uint32_t>(registers_of(type));
    if (!fits(index, at) || (!parsed->any_width && at.count != width)) {
      diagnostics_.error(error::unfit_address, given.address_place,
                         fmt::format("{} is {}{} and does not fit {}.", point.name,
                                     point.writable ? "a writable " : "a ", name_of(type), given.address),
                         fitting_address(point.writable, type, at));
      return std::nullopt;
    }
    at.count = width;
    if (at.address + at.count > size_of(at.area)) {
      diagnostics_.error(error::no_address_left, given.address_place,
                         fmt::format("{} would end at {}, behind the last address of its area.", point.name,
                                     text_of({at.area, at.address + at.count - 1, 1})),
                         fmt::format("stay below {}", size_of(at.area)));
      return std::nullopt;
    }
    return at;
  }

  [[nodiscard]] std::vector<Stretch> ranges_for(std::size_t index, std::uint32_t width) const {
    const Point& point = points_[index];
    const bool boolean = formats_[index].type == PointType::boolean;
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
    for (const Stretch& range : ranges_for(point, width)) {
      // Nothing becomes free again: what was passed over for this width once is passed over.
      std::uint32_t& at = begins_.try_emplace({range.area, range.address, width}, range.address).first->second;
      for (; at + width <= range.address + range.count; at += width) {
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
  std::vector<bool> is_exposed_;
  std::vector<PointFormat> formats_;
  std::vector<bool> is_flawed_;  ///< by point: it was given a format that does not serve
  std::vector<std::optional<Stretch>> placed_;
  std::vector<RetiredAddress> retired_;
  /// Of a range by area, address and width of values: where to look for a free address.
  std::map<std::tuple<Area, std::uint32_t, std::uint32_t>, std::uint32_t> begins_;
  Occupancy occupancy_;
  Diagnostics diagnostics_;
};

}  // namespace

std::span<const MapEntry> RegisterMap::entries_in(Area area) const {
  const std::size_t i = index_of(area);
  return std::span(entries_).subspan(first_[i], first_[i + 1] - first_[i]);
}

std::span<const MapEntry> RegisterMap::covering(Area area, std::uint32_t address) const {
  const auto list = entries_in(area);
  const auto after =
      std::ranges::upper_bound(list, address, {}, [](const MapEntry& entry) { return entry.at.address; });
  auto first = after;
  while (first != list.begin() && (first - 1)->at.address + (first - 1)->at.count > address) {
    --first;
  }
  return {first, after};
}

const MapEntry* RegisterMap::find(Area area, std::uint32_t address) const {
  const auto found = covering(area, address);
  return found.empty() ? nullptr : found.data();
}

RegisterMap make_register_map(std::span<const Point> points, const MapRequest& request) {
  Placer placer(points, request);
  placer.choose_exposed();
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
  map.warnings_ = placer.diagnostics();
  map.retired_ = placer.retired();
  for (const Area area : areas) {
    map.first_[index_of(area)] = static_cast<std::size_t>(
        std::ranges::lower_bound(map.entries_, area, {}, [](const MapEntry& entry) { return entry.at.area; }) -
        map.entries_.begin());
  }
  map.first_[4] = map.entries_.size();
  map.hash_ = sha256(fmt::format("{}\n{}", name_of(map.order_), hashed_text(map)));
  if (request.has_discovery) {
    map.chain_ = make_chain(map);
    if (chain_address + map.chain_.size() > area_size) {
      map.entrance_ = make_entrance(map);
    }
  }
  return map;
}

}  // namespace hysteron::runtime::modbus
