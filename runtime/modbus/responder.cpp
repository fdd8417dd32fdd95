#include "runtime/modbus/responder.hpp"

#include <algorithm>

#include "runtime/modbus/discovery.hpp"

namespace hysteron::runtime::modbus {
namespace {

// The limits of the specification, section 6: what fits a PDU of 253 bytes.
constexpr std::uint32_t most_bits_read = 2000;
constexpr std::uint32_t most_bits_written = 1968;
constexpr std::uint32_t most_words_read = 125;
constexpr std::uint32_t most_words_written = 123;
constexpr std::uint32_t most_words_written_and_read = 121;

constexpr std::uint8_t device_identification = 14;
constexpr std::uint8_t conformity = 0x83;  // extended objects, as a stream and one by one
constexpr std::size_t longest_object = 200;
constexpr std::array<std::uint8_t, 6> object_ids{0x00, 0x01, 0x02, 0x04, 0x80, 0x81};

constexpr std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

void put(Reply& reply, std::uint8_t byte) {
  reply.bytes[reply.size++] = byte;
}

void put_word(Reply& reply, std::uint16_t word) {
  put(reply, static_cast<std::uint8_t>(word >> 8U));
  put(reply, static_cast<std::uint8_t>(word & 0xFFU));
}

/// The request's first bytes, which are the whole answer to a write.
void echo(Reply& reply, std::span<const std::uint8_t> pdu, std::size_t count) {
  std::copy_n(pdu.begin(), count, reply.bytes.begin());
  reply.size = count;
}

constexpr bool writes(std::uint8_t function) {
  return function == 5 || function == 6 || function == 15 || function == 16 || function == 22 || function == 23;
}

constexpr bool reads(std::uint8_t function) {
  return !writes(function) || function == 23;
}

}  // namespace

Responder::Responder(const RegisterMap& map, PointDoor& door, const Identity& identity)
    : map_(&map), door_(door), objects_{identity.vendor, identity.product, identity.revision} {
  show(map);
}

void Responder::show(const RegisterMap& map) {
  map_ = &map;
  std::ranges::copy(std::array{map.title(), map.hash(), std::string(name_of(map.order()))}, objects_.begin() + 3);
  for (std::string& object : objects_) {
    object.resize(std::min(object.size(), longest_object));
  }
}

Reply Responder::answer(Pdu pdu, const Caller& caller) {
  Reply reply;
  const std::uint8_t function = pdu[0];
  const bool admitted = (!writes(function) || caller.rights.writes()) && (!reads(function) || caller.rights.read);
  reply.exception = admitted ? serve(pdu, caller, reply) : Exception::illegal_function;
  if (reply.exception != Exception::none) {
    reply.bytes[0] = function | 0x80U;
    reply.bytes[1] = static_cast<std::uint8_t>(reply.exception);
    reply.size = 2;
  }
  return reply;
}

Exception Responder::serve(Pdu pdu, const Caller& caller, Reply& reply) {
  switch (pdu[0]) {
    case 1:
      return read_bits(pdu, Area::coil, reply);
    case 2:
      return read_bits(pdu, Area::discrete_input, reply);
    case 3:
      return read_words(pdu, Area::holding_register, reply);
    case 4:
      return read_words(pdu, Area::input_register, reply);
    case 5:
      return write_one_coil(pdu, caller, reply);
    case 6:
      return write_one_register(pdu, caller, reply);
    case 15:
      return write_coils(pdu, caller, reply);
    case 16:
      return write_registers(pdu, caller, reply);
    case 20:
      return read_files(pdu, reply);
    case 22:
      return mask_register(pdu, caller, reply);
    case 23:
      return write_and_read(pdu, caller, reply);
    case 43:
      return identify(pdu, reply);
    default:
      return Exception::illegal_function;
  }
}

Exception Responder::read_bits(Pdu pdu, Area area, Reply& reply) {
  if (pdu.size() != 5) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  const std::uint32_t count = word_at(pdu, 3);
  if (count < 1 || count > most_bits_read) {
    return Exception::illegal_value;
  }
  if (!covered(area, address, count)) {
    return Exception::illegal_address;
  }
  door_.read(now_);
  put(reply, pdu[0]);
  put(reply, static_cast<std::uint8_t>((count + 7) / 8));
  const MapEntry* entry = map_->find(area, address);
  std::fill_n(reply.bytes.begin() + 2, (count + 7) / 8, std::uint8_t{0});
  for (std::uint32_t i = 0; i < count; ++i, ++entry) {  // every bit has its entry, so they follow each other
    const auto bit = bits_now(*entry);
    if (!bit) {
      return Exception::device_failure;
    }
    if (*bit != 0) {
      reply.bytes[2 + i / 8] |= static_cast<std::uint8_t>(1U << i % 8);
    }
  }
  reply.size += (count + 7) / 8;
  return Exception::none;
}

Exception Responder::read_words(Pdu pdu, Area area, Reply& reply) {
  if (pdu.size() != 5) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  const std::uint32_t count = word_at(pdu, 3);
  if (count < 1 || count > most_words_read) {
    return Exception::illegal_value;
  }
  if (!covered(area, address, count)) {
    return Exception::illegal_address;
  }
  door_.read(now_);
  put(reply, pdu[0]);
  put(reply, static_cast<std::uint8_t>(2 * count));
  return put_words(area, address, count, reply);
}

Exception Responder::write_one_coil(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() != 5 || (word_at(pdu, 3) != 0 && word_at(pdu, 3) != 0xFF00)) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  if (const auto flaw = writable(Area::coil, address, 1, caller); flaw != Exception::none) {
    return flaw;
  }
  writes_.clear();
  const std::uint64_t bit = word_at(pdu, 3) == 0 ? 0 : 1;
  if (const auto flaw = collect(*map_->find(Area::coil, address), bit); flaw != Exception::none) {
    return flaw;
  }
  echo(reply, pdu, 5);
  return hand_over(caller, reply);
}

Exception Responder::write_one_register(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() != 5) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  if (const auto flaw = writable(Area::holding_register, address, 1, caller); flaw != Exception::none) {
    return flaw;
  }
  writes_.clear();
  if (const auto flaw = collect_words(address, pdu.subspan(3)); flaw != Exception::none) {
    return flaw;
  }
  echo(reply, pdu, 5);
  return hand_over(caller, reply);
}

Exception Responder::write_coils(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() < 6) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  const std::uint32_t count = word_at(pdu, 3);
  if (count < 1 || count > most_bits_written || pdu[5] != (count + 7) / 8 || pdu.size() != 6U + pdu[5]) {
    return Exception::illegal_value;
  }
  if (const auto flaw = writable(Area::coil, address, count, caller); flaw != Exception::none) {
    return flaw;
  }
  writes_.clear();
  const MapEntry* entry = map_->find(Area::coil, address);
  for (std::uint32_t i = 0; i < count; ++i, ++entry) {
    const auto bit = static_cast<std::uint64_t>(pdu[6 + i / 8]) >> i % 8 & 1U;
    if (const auto flaw = collect(*entry, bit); flaw != Exception::none) {
      return flaw;
    }
  }
  echo(reply, pdu, 5);
  return hand_over(caller, reply);
}

Exception Responder::write_registers(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() < 6) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  const std::uint32_t count = word_at(pdu, 3);
  if (count < 1 || count > most_words_written || pdu[5] != 2 * count || pdu.size() != 6U + pdu[5]) {
    return Exception::illegal_value;
  }
  if (const auto flaw = writable(Area::holding_register, address, count, caller); flaw != Exception::none) {
    return flaw;
  }
  writes_.clear();
  if (const auto flaw = collect_words(address, pdu.subspan(6)); flaw != Exception::none) {
    return flaw;
  }
  echo(reply, pdu, 5);
  return hand_over(caller, reply);
}

Exception Responder::mask_register(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() != 7) {
    return Exception::illegal_value;
  }
  const std::uint32_t address = word_at(pdu, 1);
  if (const auto flaw = writable(Area::holding_register, address, 1, caller); flaw != Exception::none) {
    return flaw;
  }
  door_.read(now_);
  const auto entries = map_->covering(Area::holding_register, address);
  const auto now = register_bits(entries);
  if (!now) {
    return Exception::device_failure;
  }
  const std::uint64_t keep = word_at(pdu, 3);
  const std::uint64_t set = word_at(pdu, 5);
  writes_.clear();
  const std::uint64_t bits = (*now & keep) | (set & ~keep);
  if (const auto flaw = collect_register(entries, bits & 0xFFFFU); flaw != Exception::none) {
    return flaw;
  }
  echo(reply, pdu, 7);
  return hand_over(caller, reply);
}

Exception Responder::write_and_read(Pdu pdu, const Caller& caller, Reply& reply) {
  if (pdu.size() < 10) {
    return Exception::illegal_value;
  }
  const std::uint32_t read_address = word_at(pdu, 1);
  const std::uint32_t read_count = word_at(pdu, 3);
  const std::uint32_t write_address = word_at(pdu, 5);
  const std::uint32_t write_count = word_at(pdu, 7);
  if (read_count < 1 || read_count > most_words_read || write_count < 1 || write_count > most_words_written_and_read ||
      pdu[9] != 2 * write_count || pdu.size() != 10U + pdu[9]) {
    return Exception::illegal_value;
  }
  if (!covered(Area::holding_register, read_address, read_count)) {
    return Exception::illegal_address;
  }
  if (const auto flaw = writable(Area::holding_register, write_address, write_count, caller); flaw != Exception::none) {
    return flaw;
  }
  writes_.clear();
  if (const auto flaw = collect_words(write_address, pdu.subspan(10)); flaw != Exception::none) {
    return flaw;
  }
  if (const auto flaw = hand_over(caller, reply); flaw != Exception::none) {
    return flaw;
  }
  door_.read(now_);
  put(reply, pdu[0]);
  put(reply, static_cast<std::uint8_t>(2 * read_count));
  return put_words(Area::holding_register, read_address, read_count, reply);
}

/// The chain of the discovery, as files of 10000 records.
Exception Responder::read_files(Pdu pdu, Reply& reply) const {
  constexpr std::size_t request_size = 7;  // reference type, file, record, length
  constexpr std::uint8_t reference_type = 6;
  if (pdu.size() < 2 + request_size || pdu[1] != pdu.size() - 2 || pdu[1] % request_size != 0) {
    return Exception::illegal_value;
  }
  std::size_t size = 2;
  for (Pdu rest = pdu.subspan(2); !rest.empty(); rest = rest.subspan(request_size)) {
    size += 2 + std::size_t{2} * word_at(rest, 5);
    if (word_at(rest, 5) == 0 || size > longest_pdu) {
      return Exception::illegal_value;
    }
  }
  put(reply, pdu[0]);
  put(reply, static_cast<std::uint8_t>(size - 2));
  for (Pdu rest = pdu.subspan(2); !rest.empty(); rest = rest.subspan(request_size)) {
    const std::size_t record = word_at(rest, 3);
    const std::size_t count = word_at(rest, 5);
    const std::size_t first = records_of_file * (std::size_t{word_at(rest, 1)} - 1) + record;
    const bool is_there = rest[0] == reference_type && word_at(rest, 1) > 0 && record + count <= records_of_file &&
                          first + count <= map_->chain().size();
    if (!is_there) {
      return Exception::illegal_address;
    }
    put(reply, static_cast<std::uint8_t>(1 + 2 * count));
    put(reply, reference_type);
    for (const std::uint16_t word : map_->chain().subspan(first, count)) {
      put_word(reply, word);
    }
  }
  return Exception::none;
}

Exception Responder::identify(Pdu pdu, Reply& reply) const {
  if (pdu.size() < 2) {
    return Exception::illegal_value;
  }
  if (pdu[1] != device_identification) {
    return Exception::illegal_function;
  }
  if (pdu.size() != 4 || pdu[2] < 1 || pdu[2] > 4) {
    return Exception::illegal_value;
  }
  const std::uint8_t code = pdu[2];
  const bool one = code == 4;
  const std::uint8_t last = code == 1 ? 0x02 : code == 2 ? 0x7F : 0xFF;
  auto first = static_cast<std::size_t>(std::ranges::find(object_ids, pdu[3]) - object_ids.begin());
  if (first == object_ids.size() || pdu[3] > last) {
    if (one) {
      return Exception::illegal_address;
    }
    first = 0;  // the specification: as if object 0 had been asked for
  }
  for (const unsigned byte : {43U, unsigned{device_identification}, unsigned{code}, unsigned{conformity}, 0U, 0U, 0U}) {
    put(reply, static_cast<std::uint8_t>(byte));
  }
  std::uint8_t count = 0;
  for (std::size_t i = first; i < object_ids.size() && object_ids[i] <= last && (!one || i == first); ++i) {
    const std::string& text = objects_[i];
    if (reply.size + 2 + text.size() > longest_pdu) {
      reply.bytes[4] = 0xFF;  // more follows, from this object on
      reply.bytes[5] = object_ids[i];
      break;
    }
    put(reply, object_ids[i]);
    put(reply, static_cast<std::uint8_t>(text.size()));
    for (const char c : text) {
      put(reply, static_cast<std::uint8_t>(c));
    }
    ++count;
  }
  reply.bytes[6] = count;
  return Exception::none;
}

bool Responder::covered(Area area, std::uint32_t address, std::uint32_t count) const {
  const std::uint32_t end = address + count;
  const auto chain_end = chain_address + static_cast<std::uint32_t>(map_->chain_registers().size());
  for (std::uint32_t at = address; at < end;) {
    if (const MapEntry* entry = map_->find(area, at)) {
      at = entry->at.address + entry->at.count;
    } else if (area == Area::holding_register && at >= chain_address && at < chain_end) {
      at = chain_end;
    } else {
      return false;
    }
  }
  return true;
}

std::optional<std::uint64_t> Responder::bits_now(const MapEntry& entry) {
  const auto code = encoded(now_.values[entry.point], entry.format);
  if (!code) {
    return std::nullopt;
  }
  if (code->is_saturated) {
    ++saturated_;
    saturated_point_ = entry.point;
  }
  return code->bits;
}

std::optional<std::uint64_t> Responder::register_bits(std::span<const MapEntry> entries) {
  std::uint64_t all = 0;
  for (const MapEntry& entry : entries) {
    const auto bits = bits_now(entry);
    if (!bits) {
      return std::nullopt;
    }
    all |= *bits << entry.at.shift();
  }
  return all;
}

Exception Responder::put_words(Area area, std::uint32_t address, std::uint32_t count, Reply& reply) {
  for (std::uint32_t at = address; at < address + count;) {
    const auto entries = map_->covering(area, at);
    if (entries.empty()) {
      put_word(reply, map_->chain_registers()[at - chain_address]);
      ++at;
      continue;
    }
    const auto bits = register_bits(entries);
    if (!bits) {
      return Exception::device_failure;
    }
    const Stretch& where = entries.front().at;
    std::array<std::uint16_t, 4> words{};
    to_registers(*bits, entries.front().format.order, std::span(words).first(where.count));
    for (; at < std::min(address + count, where.address + where.count); ++at) {
      put_word(reply, words[at - where.address]);
    }
  }
  return Exception::none;
}

Exception Responder::writable(Area area, std::uint32_t address, std::uint32_t count, const Caller& caller) const {
  const std::uint32_t end = address + count;
  bool permitted = true;
  for (std::uint32_t at = address; at < end;) {
    const auto entries = map_->covering(area, at);
    if (entries.empty() || entries.front().at.address != at || at + entries.front().at.count > end) {
      return Exception::illegal_address;
    }
    for (const MapEntry& entry : entries) {
      if (!map_->point_of(entry).writable) {
        return Exception::illegal_address;
      }
      permitted = permitted && caller.rights.write(map_->point_of(entry).right);
    }
    at += entries.front().at.count;
  }
  return permitted ? Exception::none : Exception::illegal_function;
}

Exception Responder::collect_words(std::uint32_t address, Pdu data) {
  const auto end = address + static_cast<std::uint32_t>(data.size() / 2);
  for (std::uint32_t at = address; at < end;) {
    const auto entries = map_->covering(Area::holding_register, at);
    const std::uint32_t width = entries.front().at.count;
    std::array<std::uint16_t, 4> words{};
    for (std::uint32_t i = 0; i < width; ++i) {
      words[i] = word_at(data, std::size_t{2} * (at - address + i));
    }
    const std::uint64_t bits = from_registers(std::span(words).first(width), entries.front().format.order);
    if (const auto flaw = collect_register(entries, bits); flaw != Exception::none) {
      return flaw;
    }
    at += width;
  }
  return Exception::none;
}

Exception Responder::collect_register(std::span<const MapEntry> entries, std::uint64_t bits) {
  if (!entries.front().at.is_bit()) {
    return collect(entries.front(), bits);
  }
  for (const MapEntry& entry : entries) {
    const auto bit = std::uint64_t{1} << entry.at.shift();
    if (const auto flaw = collect(entry, (bits & bit) != 0 ? 1 : 0); flaw != Exception::none) {
      return flaw;
    }
    bits &= ~bit;
  }
  return bits == 0 ? Exception::none : Exception::illegal_value;  // no 1 is lost in silence
}

Exception Responder::collect(const MapEntry& entry, std::uint64_t bits) {
  const Point& point = map_->point_of(entry);
  const auto value = taken(bits, entry.format, point.low, point.high);
  if (!value || !holds(RegisterType(point.type), *value)) {
    return Exception::illegal_value;
  }
  writes_.push_back({entry.point, *value});
  return Exception::none;
}

Exception Responder::hand_over(const Caller& caller, Reply& reply) {
  if (caller.other_owns_writes) {
    return Exception::device_busy;
  }
  refusal_ = door_.write(writes_);
  reply.wrote = refusal_.empty();
  return reply.wrote ? Exception::none : Exception::device_failure;
}

}  // namespace hysteron::runtime::modbus
