// A second server, written from the specification in another way, that the answers of the first are held against.
//
// It keeps registers and bits as plain memory and marks every address with what may be done there, where the first
// looks points up in a sorted map and never stores a register.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::test {

class Oracle {
 public:
  using Bytes = std::vector<std::uint8_t>;

  explicit Oracle(const runtime::modbus::RegisterMap& map) : map_(map) {
    for (auto& area : cells_) {
      area.resize(0x10000);
    }
    for (const auto& entry : map.entries()) {
      for (std::uint32_t part = 0; part < entry.at.count; ++part) {
        auto& cell = cells_[static_cast<std::size_t>(entry.at.area)][entry.at.address + part];
        cell.point = static_cast<int>(entry.point);
        cell.part = part;
        cell.parts = entry.at.count;
        cell.writable = map.points()[entry.point].writable;
      }
    }
    std::size_t at = runtime::modbus::chain_address;
    for (const std::uint16_t word : map.chain_registers()) {
      cells_[holding][at].word = word;
      cells_[holding][at++].chain = true;
    }
  }

  /// The exact answer; the memory changes where the request writes.
  Bytes answer(const Bytes& pdu) {
    const int function = pdu[0];
    if (function == 20) {
      return files(pdu);
    }
    const auto form = forms().find(function);
    if (form == forms().end()) {
      return exception(function, 1);
    }
    const Form& f = form->second;
    if (const int code = wrong_form(f, pdu)) {
      return exception(function, code);
    }
    if (function == 43) {
      return identify(pdu);
    }
    Span read{f.area, f.read_at != 0 ? word(pdu, f.read_at) : 0, f.read_at != 0 ? word(pdu, f.read_at + 2) : 0};
    Span write{f.area, f.write_at != 0 ? word(pdu, f.write_at) : 0, 0};
    if (f.write_at != 0) {
      write.count = f.data_at != 0 ? word(pdu, f.write_at + 2) : 1;
    }
    if (!readable(read) || !writable(write)) {
      return exception(function, 2);
    }
    auto values = written_cells(function, pdu, write);
    if (!allowed(write, values)) {
      return exception(function, 3);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      cells_[write.area][write.address + i].word = values[i];
    }
    if (f.read_at == 0) {
      return {pdu.begin(), pdu.begin() + (function == 22 ? 7 : 5)};
    }
    return read_answer(function, read);
  }

  std::uint16_t& word_of(std::size_t area, std::size_t address) { return cells_[area][address].word; }

 private:
  struct Cell {
    int point = -1;
    std::size_t part = 0;
    std::size_t parts = 1;
    bool writable = false;
    bool chain = false;
    std::uint16_t word = 0;
  };
  struct Span {
    std::size_t area;
    std::size_t address;
    std::size_t count;
  };
  /// Where a request has its fields; 0 where it has none.
  struct Form {
    std::size_t area = 0;
    std::size_t read_at = 0;
    std::size_t most_read = 0;
    std::size_t write_at = 0;
    std::size_t most_written = 0;
    std::size_t data_at = 0;  ///< behind the byte count
    std::size_t length = 0;   ///< without data
  };
  static constexpr std::size_t coil = 0;
  static constexpr std::size_t holding = 2;

  static const std::map<int, Form>& forms() {
    static const std::map<int, Form> table{
        {1, {0, 1, 2000, 0, 0, 0, 5}},     {2, {1, 1, 2000, 0, 0, 0, 5}}, {3, {2, 1, 125, 0, 0, 0, 5}},
        {4, {3, 1, 125, 0, 0, 0, 5}},      {5, {0, 0, 0, 1, 1, 0, 5}},    {6, {2, 0, 0, 1, 1, 0, 5}},
        {15, {0, 0, 0, 1, 1968, 6, 6}},    {16, {2, 0, 0, 1, 123, 6, 6}}, {22, {2, 0, 0, 1, 1, 0, 7}},
        {23, {2, 1, 125, 5, 121, 10, 10}}, {43, {0, 0, 0, 0, 0, 0, 4}},
    };
    return table;
  }

  /// Function 20: every part names its file, its first record and how many.
  [[nodiscard]] Bytes files(const Bytes& pdu) const {
    const std::size_t bytes = pdu.size() < 2 ? 0 : pdu[1];
    if (bytes == 0 || bytes % 7 != 0 || bytes + 2 != pdu.size()) {
      return exception(20, 3);
    }
    Bytes answer{20, 0};
    bool is_there = true;
    bool is_fit = true;
    for (std::size_t part = 2; part < pdu.size(); part += 7) {
      const std::size_t file = word(pdu, part + 1);
      const std::size_t record = word(pdu, part + 3);
      const std::size_t count = word(pdu, part + 5);
      is_fit = is_fit && count > 0;
      is_there = is_there && pdu[part] == 6 && file > 0 && record + count <= 10000;
      answer.push_back(static_cast<std::uint8_t>(2 * count + 1));
      answer.push_back(6);
      for (std::size_t i = 0; i < count && answer.size() <= 300; ++i) {
        const std::size_t at = 10000 * file + record + i - 10000;
        is_there = is_there && at < map_.chain().size();
        const std::uint16_t one = is_there ? map_.chain()[at] : std::uint16_t{0};
        answer.push_back(static_cast<std::uint8_t>(one / 256));
        answer.push_back(static_cast<std::uint8_t>(one % 256));
      }
    }
    if (!is_fit || answer.size() > 253) {
      return exception(20, 3);
    }
    answer[1] = static_cast<std::uint8_t>(answer.size() - 2);
    return is_there ? answer : exception(20, 2);
  }

  static std::size_t word(const Bytes& pdu, std::size_t at) { return pdu[at] * 256U + pdu[at + 1]; }
  static Bytes exception(int function, int code) {
    return {static_cast<std::uint8_t>(function | 128), static_cast<std::uint8_t>(code)};
  }

  static int wrong_form(const Form& f, const Bytes& pdu) {
    if (pdu[0] == 43) {
      return pdu.size() >= 2 && pdu[1] != 14 ? 1 : pdu.size() != 4 || pdu[2] == 0 || pdu[2] > 4 ? 3 : 0;
    }
    if (f.data_at == 0 ? pdu.size() != f.length : pdu.size() < f.length) {
      return 3;
    }
    const auto beyond = [&](std::size_t at, std::size_t most) { return word(pdu, at) - 1 >= most; };
    if (f.read_at != 0 && beyond(f.read_at + 2, f.most_read)) {
      return 3;
    }
    if (f.data_at != 0) {
      const std::size_t count = word(pdu, f.write_at + 2);
      const std::size_t bytes = f.area == coil ? (count >> 3U) + ((count & 7U) != 0 ? 1 : 0) : count + count;
      if (beyond(f.write_at + 2, f.most_written) || pdu[f.data_at - 1] != bytes || pdu.size() - f.data_at != bytes) {
        return 3;
      }
    }
    return pdu[0] == 5 && pdu[4] != 0 ? 3 : pdu[0] == 5 && pdu[3] != 0 && pdu[3] != 255 ? 3 : 0;
  }

  [[nodiscard]] bool readable(const Span& span) const {
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::size_t at = span.address + i;
      if (at > 0xFFFF || (cells_[span.area][at].point < 0 && !cells_[span.area][at].chain)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool writable(const Span& span) const {
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::size_t at = span.address + i;
      if (at > 0xFFFF || !cells_[span.area][at].writable) {
        return false;
      }
      const Cell& cell = cells_[span.area][at];
      if (cell.part > i || cell.parts - cell.part > span.count - i) {
        return false;  // begins before the request, or ends behind it
      }
    }
    return true;
  }

  std::vector<std::uint16_t> written_cells(int function, const Bytes& pdu, const Span& span) {
    std::vector<std::uint16_t> values(span.count);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint16_t old = cells_[span.area][span.address + i].word;
      std::size_t now = 0;
      switch (function) {
        case 5:
          now = pdu[3] & 1U;
          break;
        case 15:
          now = pdu[6 + i / 8] / (std::size_t{1} << i % 8) % 2;
          break;
        case 6:
          now = word(pdu, 3);
          break;
        case 22:
          now = (old & word(pdu, 3)) + (word(pdu, 5) & (0xFFFFU - word(pdu, 3)));
          break;
        default:
          now = word(pdu, forms().at(function).data_at + 2 * i);
      }
      values[i] = static_cast<std::uint16_t>(now);
    }
    return values;
  }

  /// The value as the host's memory would hold it, by shuffling bytes.
  [[nodiscard]] bool in_range(const std::vector<std::uint16_t>& words, const runtime::Point& point) const {
    std::string bytes;
    for (const std::uint16_t one : words) {
      bytes += static_cast<char>(one / 256);
      bytes += static_cast<char>(one % 256);
    }
    const auto order = map_.order();
    using runtime::modbus::WordOrder;
    if (words.size() > 1) {
      for (std::size_t i = 0; (order == WordOrder::badc || order == WordOrder::dcba) && i < bytes.size(); i += 2) {
        std::swap(bytes[i], bytes[i + 1]);
      }
      if (order == WordOrder::cdab || order == WordOrder::dcba) {
        for (std::size_t i = 0; i < bytes.size() / 2; i += 2) {
          std::swap_ranges(bytes.begin() + static_cast<long>(i), bytes.begin() + static_cast<long>(i + 2),
                           bytes.end() - static_cast<long>(i + 2));
        }
      }
    }
    std::reverse(bytes.begin(), bytes.end());  // this host has the low byte first
    const auto within = [&](auto type) {
      std::memcpy(&type, bytes.data(), sizeof type);
      const auto value = static_cast<long double>(type);
      if (std::is_integral_v<decltype(type)> && std::fabs(value) > 9007199254740992.0L) {
        return false;
      }
      return value >= static_cast<long double>(point.low) && value <= static_cast<long double>(point.high) &&
             std::isfinite(value);
    };
    using runtime::PointType;
    switch (point.type) {
      case PointType::boolean:
        return true;
      case PointType::int16:
        return within(std::int16_t{});
      case PointType::uint16:
        return within(std::uint16_t{});
      case PointType::int32:
        return within(std::int32_t{});
      case PointType::uint32:
        return within(std::uint32_t{});
      case PointType::int64:
        return within(std::int64_t{});
      case PointType::uint64:
        return within(std::uint64_t{});
      case PointType::real32:
        return within(float{});
      case PointType::real64:
        return within(double{});
    }
    return false;
  }

  [[nodiscard]] bool allowed(const Span& span, const std::vector<std::uint16_t>& values) const {
    std::vector<std::uint16_t> words;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Cell& cell = cells_[span.area][span.address + i];
      words.push_back(values[i]);
      if (cell.part + 1 == cell.parts) {
        if (!in_range(words, map_.points()[static_cast<std::size_t>(cell.point)])) {
          return false;
        }
        words.clear();
      }
    }
    return true;
  }

  Bytes read_answer(int function, const Span& span) {
    Bytes reply{static_cast<std::uint8_t>(function), 0};
    if (function < 3) {
      for (std::size_t i = 0; i < span.count; ++i) {
        if (i % 8 == 0) {
          reply.push_back(0);
        }
        const unsigned bit = cells_[span.area][span.address + i].word;
        reply.back() = static_cast<std::uint8_t>(reply.back() + (bit << i % 8));
      }
    } else {
      for (std::size_t i = 0; i < span.count; ++i) {
        const unsigned value = cells_[span.area][span.address + i].word;
        reply.push_back(static_cast<std::uint8_t>(value / 256));
        reply.push_back(static_cast<std::uint8_t>(value % 256));
      }
    }
    reply[1] = static_cast<std::uint8_t>(reply.size() - 2);
    return reply;
  }

  [[nodiscard]] Bytes identify(const Bytes& pdu) const {
    const std::map<int, std::string> objects{{0, "Hysteron"},    {1, "hysteron-runtime"},
                                             {2, "0.1"},         {4, map_.title()},
                                             {128, map_.hash()}, {129, std::string(name_of(map_.order()))}};
    const std::array<int, 5> last{0, 2, 127, 255, 255};
    const int most = last[pdu[2]];
    int first = pdu[3];
    if (!objects.contains(first) || first > most) {
      if (pdu[2] == 4) {
        return exception(43, 2);
      }
      first = 0;
    }
    Bytes reply{43, 14, pdu[2], 0x83, 0, 0, 0};
    for (const auto& [id, text] : objects) {
      if (id >= first && id <= most && (pdu[2] != 4 || id == first)) {
        ++reply[6];
        reply.push_back(static_cast<std::uint8_t>(id));
        reply.push_back(static_cast<std::uint8_t>(text.size()));
        reply.insert(reply.end(), text.begin(), text.end());
      }
    }
    return reply;
  }

  const runtime::modbus::RegisterMap& map_;
  std::array<std::vector<Cell>, 4> cells_;
};

}  // namespace hysteron::test
