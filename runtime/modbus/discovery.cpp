#include "runtime/modbus/discovery.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

#include "runtime/modbus/value_bits.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::array<std::uint16_t, 2> magic{0x4859, 0x5354};  // HYST
constexpr std::uint16_t version = 1;
constexpr std::uint16_t point_record = 1;
constexpr std::uint16_t formatted_record = 2;
constexpr std::uint16_t files_record = 3;
constexpr std::uint16_t whole_register = 0xFFFF;
constexpr std::uint16_t end_of_chain = 0xFFFF;
constexpr std::uint16_t may_be_written = 0x8000;
constexpr std::array<std::uint16_t, 4> area_digits{0, 1, 4, 3};  // as Area: coil, discrete, holding, input

void put_text(std::vector<std::uint16_t>& words, std::string_view text) {
  words.push_back(static_cast<std::uint16_t>(text.size()));
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const unsigned high = static_cast<unsigned char>(text[i]);
    const unsigned low = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    words.push_back(static_cast<std::uint16_t>(high << 8U | low));
  }
}

void put_real(std::vector<std::uint16_t>& words, double value) {
  std::array<std::uint16_t, 4> four{};
  to_registers(std::bit_cast<std::uint64_t>(value), WordOrder::abcd, four);
  words.insert(words.end(), four.begin(), four.end());
}

/// Reads words one by one; what is missing makes it fail, never read beyond.
class WordReader {
 public:
  explicit WordReader(std::span<const std::uint16_t> words) : words_(words) {}
  std::uint16_t word() {
    if (words_.empty()) {
      failed_ = true;
      return 0;
    }
    const std::uint16_t first = words_.front();
    words_ = words_.subspan(1);
    return first;
  }
  double real() {
    std::array<std::uint16_t, 4> four{};
    for (auto& one : four) {
      one = word();
    }
    return std::bit_cast<double>(from_registers(four, WordOrder::abcd));
  }
  std::string text() {
    const std::size_t length = word();
    std::string result;
    for (std::size_t i = 0; i < length && !failed_; i += 2) {
      const std::uint16_t two = word();
      result += static_cast<char>(two >> 8U);
      result += static_cast<char>(two & 0xFFU);
    }
    result.resize(failed_ ? 0 : length);
    return result;
  }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] std::size_t left() const { return words_.size(); }

 private:
  std::span<const std::uint16_t> words_;
  bool failed_ = false;
};

bool is_plain(const RegisterMap& map, const MapEntry& entry) {
  return !entry.at.is_bit() && entry.format == PointFormat{.type = map.point_of(entry).type, .order = map.order()};
}

std::uint16_t number_of(RegisterType type) {
  return static_cast<std::uint16_t>(std::ranges::find(register_types, type) - register_types.begin());
}

/// Scale, offset, word order and bit; false where they are none.
bool read_format(WordReader& reader, DiscoveredPoint& found) {
  found.format.scale = reader.real();
  found.format.offset = reader.real();
  const std::uint16_t order = reader.word();
  const std::uint16_t bit = reader.word();
  if (order >= word_orders.size() || (bit > 15 && bit != whole_register)) {
    return false;
  }
  found.format.order = word_orders.at(order);
  found.at.bit = bit == whole_register ? no_bit : static_cast<std::int8_t>(bit);
  return true;
}

std::optional<DiscoveredPoint> read_point(WordReader& reader, bool is_formatted, WordOrder order) {
  DiscoveredPoint found{.format = {.order = order}};
  const std::uint16_t length = reader.word();
  const std::size_t before = reader.left();
  const std::uint16_t digit = reader.word();
  found.at.address = reader.word();
  const std::uint16_t type = reader.word();
  const std::uint16_t access = reader.word();
  found.point.low = reader.real();
  found.point.high = reader.real();
  found.point.name = reader.text();
  found.point.unit = reader.text();
  const std::uint16_t kind = access & 0xFFU;
  if ((is_formatted && !read_format(reader, found)) || reader.failed() || before - reader.left() != length ||
      type >= (is_formatted ? register_types.size() : point_types.size()) ||
      kind > static_cast<std::uint16_t>(PointKind::command)) {
    return std::nullopt;
  }
  found.format.type = register_types.at(type);
  found.point.type = found.format.type.type;
  found.point.kind = static_cast<PointKind>(kind);
  found.point.writable = (access & may_be_written) != 0;
  found.at.count = static_cast<std::uint32_t>(registers_of(found.format.type));
  for (const Area area : areas) {
    if (area_digits[static_cast<std::size_t>(area)] == digit) {
      found.at.area = area;
      return found;
    }
  }
  return std::nullopt;
}

std::vector<std::uint16_t> head_of(const RegisterMap& map, std::size_t points) {
  std::vector<std::uint16_t> words(magic.begin(), magic.end());
  words.push_back(version);
  words.push_back(static_cast<std::uint16_t>(map.order()));
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint16_t four_digits = 0;
    const char* const digits = map.hash().data() + 4 * i;
    std::from_chars(digits, digits + 4, four_digits, 16);
    words.push_back(four_digits);
  }
  words.push_back(static_cast<std::uint16_t>(points));
  return words;
}

}  // namespace

std::vector<std::uint16_t> make_chain(const RegisterMap& map) {
  std::vector<std::uint16_t> words = head_of(map, map.entries().size());
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    const bool is_formatted = !is_plain(map, entry);
    std::vector<std::uint16_t> record;
    record.push_back(area_digits[static_cast<std::size_t>(entry.at.area)]);
    record.push_back(static_cast<std::uint16_t>(entry.at.address));
    record.push_back(number_of(entry.format.type));
    record.push_back(
        static_cast<std::uint16_t>((point.writable ? may_be_written : 0U) | static_cast<unsigned>(point.kind)));
    put_real(record, point.low);
    put_real(record, point.high);
    put_text(record, point.name);
    put_text(record, point.unit);
    if (is_formatted) {
      put_real(record, entry.format.scale);
      put_real(record, entry.format.offset);
      record.push_back(static_cast<std::uint16_t>(entry.format.order));
      record.push_back(entry.at.is_bit() ? static_cast<std::uint16_t>(entry.at.bit) : whole_register);
    }
    words.push_back(is_formatted ? formatted_record : point_record);
    words.push_back(static_cast<std::uint16_t>(record.size()));
    words.insert(words.end(), record.begin(), record.end());
  }
  words.push_back(end_of_chain);
  words.push_back(0);
  return words;
}

std::vector<std::uint16_t> make_entrance(const RegisterMap& map) {
  const std::size_t chain_size = map.chain().size();
  std::vector<std::uint16_t> words = head_of(map, 0);
  const std::array<std::uint16_t, 6> rest{
      files_record, 2, static_cast<std::uint16_t>(chain_size >> 16U), static_cast<std::uint16_t>(chain_size & 0xFFFFU),
      end_of_chain, 0};
  words.insert(words.end(), rest.begin(), rest.end());
  return words;
}

std::optional<DiscoveredMap> read_chain(std::span<const std::uint16_t> chain) {
  WordReader reader(chain);
  DiscoveredMap map;
  const bool ours = reader.word() == magic[0] && reader.word() == magic[1] && reader.word() == version;
  const std::uint16_t order = reader.word();
  if (!ours || order >= word_orders.size()) {
    return std::nullopt;
  }
  map.order = static_cast<WordOrder>(order);
  constexpr std::string_view digits = "0123456789abcdef";
  for (int i = 0; i < 8; ++i) {
    const std::uint16_t word = reader.word();
    for (const unsigned shift : {12U, 8U, 4U, 0U}) {
      map.hash += digits[word >> shift & 0xFU];
    }
  }
  const std::size_t count = reader.word();
  std::uint16_t record = reader.word();
  for (; (record == point_record || record == formatted_record) && !reader.failed(); record = reader.word()) {
    auto point = read_point(reader, record == formatted_record, map.order);
    if (!point) {
      return std::nullopt;
    }
    map.points.push_back(std::move(*point));
  }
  if (record == files_record && reader.word() == 2) {
    const std::uint32_t high = reader.word();
    map.in_files = high << 16U | reader.word();
    record = reader.word();
  }
  const bool ends = map.points.size() == count && record == end_of_chain && reader.word() == 0 && !reader.failed();
  return ends ? std::optional(std::move(map)) : std::nullopt;
}

}  // namespace hysteron::runtime::modbus
