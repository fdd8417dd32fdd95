#include "records/formats.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "records/binary/readers.hpp"
#include "records/text/text_reader.hpp"

namespace hysteron::records {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view from_python =
    "in Python, pandas.DataFrame(...).to_csv(\"log.csv\") writes what is read here.";

bool begins(std::string_view bytes, std::string_view with, std::size_t at = 0) {
  return bytes.size() >= at + with.size() && bytes.substr(at, with.size()) == with;
}

constexpr std::string_view hdf5_mark = "\x89HDF\r\n\x1A\n";

constexpr auto formats = std::to_array<Format>({
    {"MATLAB", [](std::string_view bytes, std::string_view) { return begins(bytes, "MATLAB 7.3 MAT-file") || begins(bytes, "MATLAB 5.0 MAT-file"); },
     read_mat, ""},
    {"HDF5", [](std::string_view bytes, std::string_view ending) {
       // What a user puts before it takes 512 bytes, or twice, four times … as many.
       return ending == "h5" || ending == "hdf5" || begins(bytes, hdf5_mark) || begins(bytes, hdf5_mark, 512) || begins(bytes, hdf5_mark, 1024);
     },
     read_hdf5, ""},
    {"TDMS of LabVIEW", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "TDSm") || ending == "tdms"; }, nullptr,
     "write a .lvm instead (Write To Measurement File, text), or export it: in Python, nptdms.TdmsFile(\"log.tdms\")."
     "as_dataframe().to_csv(\"log.csv\")."},
    {"MDF of ASAM", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "MDF     ") || begins(bytes, "UnFinMF ") || ending == "mf4"; },
     nullptr, "export it as CSV: in Python, asammdf.MDF(\"log.mf4\").export(\"csv\", \"log.csv\")."},
    {"Parquet", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "PAR1") || ending == "parquet"; }, nullptr,
     "export it: in Python, pandas.read_parquet(\"log.parquet\").to_csv(\"log.csv\")."},
    {"ROS bag", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "#ROSBAG") || ending == "bag"; }, nullptr,
     "export the topic: rostopic echo -b FILE -p /TOPIC > log.csv; or open it in PlotJuggler and export CSV."},
    {"MCAP", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "\x89MCAP0\r\n") || ending == "mcap"; }, nullptr,
     "open it in PlotJuggler or Foxglove and export the signals as CSV."},
    {"SQLite (ROS 2 bag)", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "SQLite format 3\0"sv) || ending == "db3"; },
     nullptr, "open it in PlotJuggler and export the signals as CSV."},
    {"Excel workbook", [](std::string_view bytes, std::string_view ending) {
       return ending == "xlsx" || ending == "xlsm" || ending == "ods" || ending == "xls" || begins(bytes, "\xD0\xCF\x11\xE0");
     },
     nullptr, "save the sheet as CSV UTF-8."},
    {"zip archive", [](std::string_view bytes, std::string_view) { return begins(bytes, "PK\x03\x04"); }, nullptr,
     "unpack it; a workbook has to be saved as CSV UTF-8."},
    {"gzip archive", [](std::string_view bytes, std::string_view) { return begins(bytes, "\x1F\x8B"); }, nullptr,
     "unpack it: gunzip FILE."},
    {"WAV sound", [](std::string_view bytes, std::string_view) { return (begins(bytes, "RIFF") || begins(bytes, "RF64")) && begins(bytes, "WAVE", 8); },
     read_wav, ""},
    {"LeCroy waveform", [](std::string_view bytes, std::string_view) { return bytes.substr(0, 64).find("WAVEDESC") != std::string_view::npos; },
     nullptr, "save the waveform as ASCII or CSV on the oscilloscope."},
    {"Tektronix waveform", [](std::string_view bytes, std::string_view ending) { return ending == "wfm" || ending == "isf" || begins(bytes, ":WFM"); }, nullptr,
     "save the waveform as CSV on the oscilloscope."},
    {"PicoScope data", [](std::string_view, std::string_view ending) { return ending == "psdata"; }, nullptr,
     "in PicoScope, File, Save as, CSV."},
    {"TwinCAT Scope data", [](std::string_view, std::string_view ending) { return ending == "svdx" || ending == "svd" || ending == "tcscopex"; }, nullptr,
     "in TwinCAT Scope, export the chart as CSV, or call TC3ScopeExportTool with target=CSV."},
    {"PNG picture", [](std::string_view bytes, std::string_view) { return begins(bytes, "\x89PNG"); }, nullptr,
     "export the numbers, not the picture, as CSV."},
    {"PDF", [](std::string_view bytes, std::string_view) { return begins(bytes, "%PDF"); }, nullptr,
     "export the numbers as CSV."},
    {"JSON", [](std::string_view bytes, std::string_view ending) {
       const auto first = bytes.find_first_not_of(" \t\r\n");
       return first != std::string_view::npos && (bytes[first] == '{' || (bytes[first] == '[' && ending == "json"));
     },
     nullptr, from_python},
    {"XML", [](std::string_view bytes, std::string_view) { return begins(bytes, "<?xml") || begins(bytes, "\xEF\xBB\xBF<?xml"); }, nullptr,
     "export the record as CSV."},
    {"text", [](std::string_view, std::string_view) { return true; }, read_text, ""},
});

}  // namespace

const Format& format_of(const std::string& file, std::string_view bytes) {
  const auto dot = file.find_last_of("./");
  std::string ending = dot == std::string::npos || file[dot] == '/' ? std::string() : file.substr(dot + 1);
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return *std::ranges::find_if(formats, [&](const Format& one) { return one.is_it(bytes, ending); });
}

}  // namespace hysteron::records
