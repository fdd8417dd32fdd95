// Sound files as records: oscilloscopes of the sound card, microphones, loggers of vibration. By libsndfile.
#include <fmt/format.h>
#include <sndfile.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

#include "records/binary/array_list.hpp"
#include "records/binary/readers.hpp"
#include "records/column_table.hpp"

namespace hysteron::records {
namespace {

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

/// The bytes as libsndfile reads a file.
struct Stream {
  std::string_view bytes{};
  sf_count_t at = 0;

  static Stream& of(void* user) { return *static_cast<Stream*>(user); }
  static sf_count_t size(void* user) { return static_cast<sf_count_t>(of(user).bytes.size()); }
  static sf_count_t seek(sf_count_t offset, int whence, void* user) {
    Stream& stream = of(user);
    const sf_count_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? stream.at : size(user);
    stream.at = std::clamp<sf_count_t>(from + offset, 0, size(user));
    return stream.at;
  }
  static sf_count_t read(void* to, sf_count_t count, void* user) {
    Stream& stream = of(user);
    count = std::clamp<sf_count_t>(count, 0, size(user) - stream.at);
    std::memcpy(to, stream.bytes.data() + stream.at, static_cast<std::size_t>(count));
    stream.at += count;
    return count;
  }
  static sf_count_t write(const void* /*from*/, sf_count_t /*count*/, void* /*user*/) { return 0; }
  static sf_count_t tell(void* user) { return of(user).at; }
};

bool is_float(const SF_INFO& info) {
  const int kind = info.format & SF_FORMAT_SUBMASK;
  return kind == SF_FORMAT_FLOAT || kind == SF_FORMAT_DOUBLE;
}

}  // namespace

Table read_wav(const std::string& file, std::string bytes, const ReadOptions& options) {
  Stream stream{.bytes = bytes};
  SF_VIRTUAL_IO access{.get_filelen = &Stream::size,
                       .seek = &Stream::seek,
                       .read = &Stream::read,
                       .write = &Stream::write,
                       .tell = &Stream::tell};
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, CloseSound> opened(sf_open_virtual(&access, SFM_READ, &info, &stream));
  constexpr int most_channels = 1024;
  if (opened == nullptr || info.channels < 1 || info.channels > most_channels || info.samplerate < 1) {
    refuse_broken(file, "WAV");
  }
  const auto channels = static_cast<std::size_t>(info.channels);
  std::vector<NumberColumn> columns(channels + 1);
  columns[0] = {.name = "t", .unit = "s", .is_time = true};
  for (std::size_t i = 0; i < channels; ++i) {
    columns[i + 1].name = fmt::format("CH{}", i + 1);
  }
  // What a header claims to hold is not believed: it is read until nothing comes.
  constexpr sf_count_t frames_at_once = 4096;
  std::vector<double> frames(static_cast<std::size_t>(frames_at_once) * channels);
  for (sf_count_t got = frames_at_once; got == frames_at_once;) {
    got = sf_readf_double(opened.get(), frames.data(), frames_at_once);
    for (std::size_t k = 0; k < static_cast<std::size_t>(std::max<sf_count_t>(got, 0)); ++k) {
      columns[0].values.push_back(static_cast<double>(columns[0].values.size()) / info.samplerate);
      for (std::size_t i = 0; i < channels; ++i) {
        columns[i + 1].values.push_back(frames[k * channels + i]);
      }
    }
  }
  Table table = table_of(file, std::move(columns), options);
  table.notes.push_back(fmt::format("WAV: {} rows a second{}", info.samplerate,
                                    is_float(info) ? "" : "; whole numbers as parts of full scale, from -1 to 1"));
  return table;
}

}  // namespace hysteron::records
