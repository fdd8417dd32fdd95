#include "runtime/modbus/discovery.hpp"

#include <array>
#include <bit>
#include <charconv>

#include "runtime/modbus/value_bits.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::array<std::uint16_t, 2> magic{0x4859, 0x5354};  // HYST
constexpr std::uint16_t version = 1;
constexpr std::uint16_t point_record = 1;
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

std::optional<DiscoveredPoint> read_point(WordReader& reader) {
  DiscoveredPoint found;
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
  if (reader.failed() || before - reader.left() != length || type >= point_types.size() ||
      kind > static_cast<std::uint16_t>(PointKind::command)) {
    return std::nullopt;
  }
  found.point.type = static_cast<PointType>(type);
  found.point.kind = static_cast<PointKind>(kind);
  found.point.writable = (access & may_be_written) != 0;
  found.at.count = static_cast<std::uint32_t>(registers_of(found.point.type));
  for (const Area area : areas) {
    if (area_digits[static_cast<std::size_t>(area)] == digit) {
      found.at.area = area;
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::uint16_t> make_chain(const RegisterMap& map) {
  std::vector<std::uint16_t> words(magic.begin(), magic.end());
  words.push_back(version);
  words.push_back(static_cast<std::uint16_t>(map.order()));
  for (std::size_t i = 0; i < 8; ++i) {
    std::uint16_t four_digits = 0;
    const char* const digits = map.hash().data() + 4 * i;
    std::from_chars(digits, digits + 4, four_digits, 16);
    words.push_back(four_digits);
  }
  words.push_back(static_cast<std::uint16_t>(map.entries().size()));
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    std::vector<std::uint16_t> record;
    record.push_back(area_digits[static_cast<std::size_t>(entry.at.area)]);
    record.push_back(static_cast<std::uint16_t>(entry.at.address));
    record.push_back(static_cast<std::uint16_t>(point.type));
    record.push_back(
        static_cast<std::uint16_t>((point.writable ? may_be_written : 0U) | static_cast<unsigned>(point.kind)));
    put_real(record, point.low);
    put_real(record, point.high);
    put_text(record, point.name);
    put_text(record, point.unit);
    words.push_back(point_record);
    words.push_back(static_cast<std::uint16_t>(record.size()));
    words.insert(words.end(), record.begin(), record.end());
  }
  words.push_back(end_of_chain);
  words.push_back(0);
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
  for (std::size_t i = 0; i < count; ++i) {
    if (reader.word() != point_record) {
      return std::nullopt;
    }
    auto point = read_point(reader);
    if (!point) {
      return std::nullopt;
    }
    map.points.push_back(std::move(*point));
  }
  const bool ends = reader.word() == end_of_chain && reader.word() == 0 && !reader.failed();
  return ends ? std::optional(std::move(map)) : std::nullopt;
}

}  // namespace hysteron::runtime::modbus
