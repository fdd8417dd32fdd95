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

/// Version 4 has no mark: its head is five small whole numbers of 32 bits. Text has no byte of zero.
bool is_mat4(std::string_view bytes, std::string_view ending) {
  return ending == "mat" && bytes.size() > 20 && bytes.substr(0, 20).find('\0') != std::string_view::npos;
}

/// `rig,host=a u=0.3,y=1.05 1717408800000000000`
bool is_line_protocol(std::string_view line) {
  line = line.substr(0, line.find('\r'));
  const auto fields = line.find(' ');
  const auto time = line.rfind(' ');
  constexpr std::string_view digits = "0123456789";
  return time != std::string_view::npos && fields < time && line.size() - time > 10 &&
         line.find_first_not_of(digits, time + 1) == std::string_view::npos &&
         line.substr(fields, time - fields).find('=') != std::string_view::npos &&
         digits.find(line.front()) == std::string_view::npos &&
         line.substr(fields + 1, time - fields - 1).find(' ') == std::string_view::npos;
}

/// `(1717408800.001000) can0 100#0011223344556677`
bool is_candump(std::string_view line) {
  const auto close = line.find(") ");
  const auto mark = line.find('#');
  return line.starts_with('(') && close != std::string_view::npos && mark != std::string_view::npos && close < mark &&
         line.substr(close + 2, mark - close).find("can") != std::string_view::npos;
}

/// `>u:1717408800001:0.1`, and `>u:0.1`
bool is_teleplot(std::string_view line) {
  const auto colon = line.find(':');
  constexpr std::string_view of_number = "0123456789+-.";
  return line.starts_with('>') && colon != std::string_view::npos && colon > 1 && colon + 1 < line.size() &&
         of_number.find(line[colon + 1]) != std::string_view::npos;
}

constexpr auto formats = std::to_array<Format>({
    {"MATLAB", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "MATLAB 7.3 MAT-file") || begins(bytes, "MATLAB 5.0 MAT-file") || is_mat4(bytes, ending); },
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
    {"a database of SQLite", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "SQLite format 3\0"sv) || ending == "db3"; },
     nullptr, "export its rows as CSV. A history of `hysteron serve`: `hysteron history FILE --out log.csv`; a bag of ROS 2: open it in "
     "PlotJuggler; another: sqlite3 -header -csv FILE 'SELECT * FROM TABLE' > log.csv."},
    {"Excel workbook", [](std::string_view bytes, std::string_view ending) {
       return ending == "xlsx" || ending == "xlsm" || ending == "ods" || (ending == "xls" && !begins(bytes, "<")) || begins(bytes, "\xD0\xCF\x11\xE0");
     },
     nullptr, "save the sheet as CSV UTF-8."},
    {"NumPy archive", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "PK\x03\x04") && ending == "npz"; }, nullptr,
     "write it as text: in Python, log = numpy.load(\"log.npz\"), then numpy.savetxt as CSV; or give the arrays to hysteron in Python."},
    {"zip archive", [](std::string_view bytes, std::string_view) { return begins(bytes, "PK\x03\x04"); }, nullptr,
     "unpack it; a workbook has to be saved as CSV UTF-8."},
    {"NumPy array", [](std::string_view bytes, std::string_view) { return begins(bytes, "\x93NUMPY"); }, nullptr,
     "write it as text: in Python, numpy.savetxt(\"log.csv\", numpy.column_stack([t, u, y]), delimiter=\",\", header=\"t,u,y\", "
     "comments=\"\"); or give the arrays to hysteron in Python."},
    {"pickle of Python", [](std::string_view, std::string_view ending) { return ending == "pkl" || ending == "pickle"; }, nullptr,
     "export it: in Python, pandas.read_pickle(\"log.pkl\").to_csv(\"log.csv\")."},
    {"Arrow or Feather table", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "ARROW1") || ending == "feather"; },
     nullptr, "export it: in Python, pandas.read_feather(\"log.feather\").to_csv(\"log.csv\")."},
    {"ULog of PX4", [](std::string_view bytes, std::string_view) { return begins(bytes, "ULog\x01\x12\x35"); }, nullptr,
     "write its topics as CSV: ulog2csv log.ulg, of pyulog; or open it in PlotJuggler and export CSV."},
    {"BLF of Vector", [](std::string_view bytes, std::string_view ending) { return begins(bytes, "LOGG") || ending == "blf"; }, nullptr,
     "decode its signals with their DBC file, and export them as CSV or MDF: in CANalyzer, or by asammdf in Python."},
    {"Access database", [](std::string_view bytes, std::string_view ending) {
       return ending == "mdb" || ending == "accdb" || bytes.substr(0, 32).find("Standard Jet DB") != std::string_view::npos;
     },
     nullptr, "export the table as CSV: in Access, External Data, Export, Text File; or mdb-export FILE TABLE > log.csv."},
    {"Keysight or Rigol waveform", [](std::string_view bytes, std::string_view ending) {
       return begins(bytes, "AG10") || begins(bytes, "AG01") || begins(bytes, "RG01") || ending == "wdf" || ending == "wvf";
     },
     nullptr, "save the waveform as CSV on the oscilloscope."},
    {"Saleae capture", [](std::string_view, std::string_view ending) { return ending == "sal" || ending == "logicdata"; }, nullptr,
     "in Logic, File, Export Data, CSV."},
    {"DIAdem or DEWESoft data", [](std::string_view, std::string_view ending) { return ending == "tdm" || ending == "tdx" || ending == "dxd" || ending == "d7d"; },
     nullptr, "export the channels as CSV or text in the program that wrote it."},
    {"compressed archive", [](std::string_view bytes, std::string_view) {
       return begins(bytes, "7z\xBC\xAF") || begins(bytes, "BZh") || begins(bytes, "\xFD" "7zXZ") || begins(bytes, "\x28\xB5\x2F\xFD") || begins(bytes, "Rar!");
     },
     nullptr, "unpack it."},
    {"web page", [](std::string_view bytes, std::string_view) {
       const auto first = bytes.substr(0, 200);
       return first.find("<html") != std::string_view::npos || first.find("<!DOCTYPE html") != std::string_view::npos ||
              first.find("<HTML") != std::string_view::npos;
     },
     nullptr, "export the numbers as CSV; an .xls that is a web page is saved anew as CSV UTF-8 by the spreadsheet."},
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
    {"a dictionary of Python in each line", [](std::string_view bytes, std::string_view) {
       const auto first = bytes.substr(0, bytes.find('\n'));
       return begins(first, "{'") && first.find("': ") != std::string_view::npos;
     },
     nullptr, "in Python, pandas.DataFrame([ast.literal_eval(line) for line in open(\"log.txt\")]).to_csv(\"log.csv\") writes what is "
     "read here; or write json.dumps(row) in place of str(row)."},
    {"JSON, an object in each line", [](std::string_view bytes, std::string_view) {
       const auto end = bytes.find('\n');
       const auto first = bytes.find_first_not_of(" \t\r\n");
       return first != std::string_view::npos && bytes[first] == '{' && end != std::string_view::npos && end > first &&
              bytes.substr(0, end).find_last_of('}') != std::string_view::npos && bytes.substr(end + 1, 1) == "{";
     },
     nullptr, "in Python, pandas.read_json(\"log.json\", lines=True).to_csv(\"log.csv\") writes what is read here."},
    {"JSON", [](std::string_view bytes, std::string_view ending) {
       const auto first = bytes.find_first_not_of(" \t\r\n");
       return first != std::string_view::npos && (bytes[first] == '{' || (bytes[first] == '[' && ending == "json"));
     },
     nullptr, from_python},
    {"Octave text with several variables",
     [](std::string_view bytes, std::string_view) {
       const auto first = begins(bytes, "# Created by Octave") ? bytes.find("# name:") : std::string_view::npos;
       return first != std::string_view::npos && bytes.find("# name:", first + 1) != std::string_view::npos;
     },
     nullptr, "save it as a MAT-file: in Octave, save(\"-v7\", \"log.mat\", \"t\", \"u\", \"y\")."},
    {"line protocol of InfluxDB", [](std::string_view bytes, std::string_view) { return is_line_protocol(bytes.substr(0, bytes.find('\n'))); },
     nullptr, "export the signals as CSV: `influx query --raw`, or the CSV of Grafana or of the data explorer."},
    {"text of Prometheus", [](std::string_view bytes, std::string_view) { return begins(bytes, "# HELP ") || begins(bytes, "# TYPE "); },
     nullptr, "export the signals as CSV with their times: the CSV of Grafana, for instance."},
    {"a log of ArduPilot", [](std::string_view bytes, std::string_view) { return begins(bytes, "FMT, ") || begins(bytes, "\xA3\x95\x80"); },
     nullptr, "write one kind of its messages as CSV: `mavlogdump.py --types PIDR --format csv log.bin > log.csv`; or open it in PlotJuggler."},
    {"Teleplot, a signal in each line", [](std::string_view bytes, std::string_view) { return is_teleplot(bytes.substr(0, bytes.find('\n'))); },
     nullptr, "export the signals as CSV from Teleplot, or print them in one line: t:0.001,u:1.5,y:2.5."},
    {"YAML", [](std::string_view bytes, std::string_view ending) { return ending == "yaml" || ending == "yml" || begins(bytes, "%YAML"); },
     nullptr, "in Python, pandas.DataFrame(yaml.safe_load(open(\"log.yaml\"))).to_csv(\"log.csv\") writes what is read here."},
    {"VCD, the value changes of a simulation",
     [](std::string_view bytes, std::string_view ending) {
       return ending == "vcd" || (begins(bytes, "$") && bytes.substr(0, 4000).find("$enddefinitions") != std::string_view::npos);
     },
     nullptr, "export the signals as CSV at even times in the program that shows them."},
    {"UFF, a universal file",
     [](std::string_view bytes, std::string_view ending) {
       return ending == "unv" || ending == "uff" || begins(bytes, "    -1\n") || begins(bytes, "    -1\r\n");
     },
     nullptr, "export the channels as CSV in the program that wrote it; or, in Python, by pyuff."},
    {"COMTRADE", [](std::string_view bytes, std::string_view ending) { return ending == "cff" || begins(bytes, "--- file type: CFG"); },
     nullptr, "export the channels as CSV; or, in Python, by the package comtrade: its numbers need the scales of the configuration."},
    {"a log of CAN frames",
     [](std::string_view bytes, std::string_view ending) {
       const auto first = bytes.substr(0, 400);
       return ending == "trc" || begins(bytes, ";$FILEVERSION") ||
              (begins(bytes, "date ") && first.find("\nbase ") != std::string_view::npos) ||
              is_candump(bytes.substr(0, bytes.find('\n')));
     },
     nullptr,
     "decode its signals with their DBC file, and export them as CSV: in CANalyzer or PCAN-View, or by cantools or asammdf in Python."},
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
