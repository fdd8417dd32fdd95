// The simulated machine as a command: its records are read and written like those of a real one.
#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "examples/05_simulated_actuator/simulator.hpp"
#include "records/csv.hpp"
#include "records/read.hpp"
#include "support/render.hpp"

namespace {

using hysteron::records::Record;

constexpr std::string_view usage =
    "A simulated piezo actuator. What it writes is simulated, not measured.\n"
    "\n"
    "  hysteron-simulate identify OUT.csv     its identification record: t, u, y; 40 periods of 1 Hz, 0 to 3.6 V\n"
    "  hysteron-simulate reference OUT.csv    the reference of a feedforward test: t, ref, u; u by a straight line\n"
    "  hysteron-simulate play IN.csv OUT.csv  plays the u of a record at 200 Hz from rest, and adds the y that "
    "answers\n"
    "\n"
    "t in seconds, u in volts, ref and y in micrometres. Equal input gives equal output, to the bit.\n";

void identify(const std::string& out) {
  const simulated::Settings settings;
  const std::vector<double> u = simulated::identification_voltage(settings.sample_time);
  Record record = Record::even(0.0, settings.sample_time, u.size());
  record.add({.name = "u", .unit = "", .values = u});
  record.add({.name = "y", .unit = "", .values = simulated::play(u, settings)});
  hysteron::records::write_csv(out, record);
}

void reference(const std::string& out) {
  const simulated::Settings settings;
  const std::vector<double> ref = simulated::test_reference(settings.sample_time);
  Record record = Record::even(0.0, settings.sample_time, ref.size());
  record.add({.name = "ref", .unit = "", .values = ref});
  record.add({.name = "u", .unit = "", .values = simulated::voltage_without_model(ref)});
  hysteron::records::write_csv(out, record);
}

int play(const std::string& in, const std::string& out) {
  simulated::Settings settings;
  settings.seed = 2;  // not the noise of the identification
  const Record played = hysteron::records::read_record(in);
  if (std::abs(played.sample_time() - settings.sample_time) > 1e-6 * settings.sample_time) {
    fmt::print(stderr, "{}: the sample time is {} s, but the simulated machine has {} s\n", in, played.sample_time(),
               settings.sample_time);
    return 1;
  }
  Record record({played.time().begin(), played.time().end()}, played.sample_time(), {}, {});
  for (const auto& column : played.columns()) {
    if (&column != played.find("y")) {
      record.add(column);
    }
  }
  record.add({.name = "y", .unit = "", .values = simulated::play(played.column("u").values, settings)});
  hysteron::records::write_csv(out, record);
  return 0;
}

int run(std::span<char*> words) {
  const std::string_view verb = words.size() > 1 ? words[1] : "";
  if (verb == "identify" && words.size() == 3) {
    identify(words[2]);
    return 0;
  }
  if (verb == "reference" && words.size() == 3) {
    reference(words[2]);
    return 0;
  }
  if (verb == "play" && words.size() == 4) {
    return play(words[2], words[3]);
  }
  fmt::print(verb == "--help" ? stdout : stderr, "{}", usage);
  return verb == "--help" ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv, static_cast<std::size_t>(argc)});
  } catch (const hysteron::InputError& error) {
    hysteron::Sources sources;
    fmt::print(stderr, "{}", as_text(error.diagnostics(), sources));
    return 1;
  }
}
