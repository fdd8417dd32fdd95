#include "runtime/config/run_keys.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "runtime/modbus/value_bits.hpp"

namespace hysteron::runtime {
namespace {

using Words = std::string_view;
using enum KeyKind;

constexpr double us = 1e3;
constexpr double ms = 1e6;
constexpr double s = 1e9;
constexpr double many = 1e12;

constexpr std::array<Words, 3> missed_words{"skip", "catch_up", "stop"};
constexpr std::array<Words, 3> scheduling_words{"fifo", "deadline", "other"};
constexpr std::array<Words, 3> on_fault_words{"value", "ramp", "hold"};
constexpr std::array<Words, 2> loss_words{"fault", "keep"};
constexpr std::array<Words, 2> overload_words{"tell", "fault"};
constexpr std::array<Words, 2> absence_words{"fault", "go_on"};
constexpr std::array<Words, 4> area_words{"holding", "input", "coil", "discrete"};
constexpr std::array<Words, 2> written_area_words{"holding", "coil"};
constexpr auto type_words = [] {
  std::array<Words, modbus::register_types.size()> words{};
  std::ranges::transform(modbus::register_types, words.begin(),
                         [](modbus::RegisterType type) { return Words(modbus::name_of(type)); });
  return words;
}();
constexpr std::array<Words, 3> parity_words{"even", "odd", "none"};
constexpr std::array<Words, 4> order_words{"abcd", "cdab", "badc", "dcba"};
constexpr std::array<Words, 2> map_words{"compact", "openplc"};
constexpr std::array<Words, 3> mismatch_words{"refuse", "cold", "carry"};
constexpr std::array<Words, 3> heartbeat_words{"off", "any", "write"};
constexpr std::array<Words, 2> after_words{"resume", "reset"};
constexpr std::array<Words, 2> connection_words{"own", "shared"};
constexpr std::array<Words, 2> payload_words{"json", "sparkplug-b"};

// How a value lies in registers: the same keys for the server's points and for values on devices.
constexpr RunKey type_key(Words otherwise, Words meaning) {
  return {.name = "type", .kind = choice, .otherwise = otherwise, .meaning = meaning, .words = type_words};
}
constexpr RunKey scale_key{"scale", number, "1.0",
                           "in the value's unit, what a step of the raw number is: value = scale·raw + offset"};
constexpr RunKey offset_key{"offset", number, "0.0", "the value where the raw number is 0"};
constexpr RunKey order_key(Words otherwise) {
  return {.name = "word_order",
          .kind = choice,
          .otherwise = otherwise,
          .meaning = "how a value of 32 or 64 bits lies in its registers",
          .words = order_words};
}

// A serial line, of a device or of the server.
constexpr RunKey baud_key{"baud", whole, "19200", "of the serial line", 300.0, 4e6};
constexpr RunKey parity_key{
    .name = "parity", .kind = choice, .otherwise = "\"even\"", .meaning = "of the serial line", .words = parity_words};
constexpr RunKey stop_key{"stop_bits", whole, "1", "of the serial line", 1.0, 2.0};
constexpr RunKey echo_key{"echo", flag, "false", "the line's adapter of RS-485 gives back what is sent"};

constexpr std::array task_keys{
    RunKey{"period", time, "(the diagram's)", "for the reader: must be the sample time of the diagram", 1.0, many},
    RunKey{.name = "missed",
           .kind = choice,
           .otherwise = "\"skip\"",
           .meaning = "what follows a missed period: it is left out, made up for, or ends the task",
           .words = missed_words},
    RunKey{"catch_up", whole, "3", "periods made up for at once, at the most", 1.0, 1000.0},
    RunKey{"tolerance",
           time,
           "(a tenth of the period)",
           "a cycle that starts later than this is late",
           1.0,
           many,
           {},
           "no more than the period"},
    RunKey{"load", number, "0.8", "of the time, what the cyclic thread may compute; more is an overload", 1e-3, 1.0},
    RunKey{.name = "on_overload",
           .kind = choice,
           .otherwise = "\"tell\"",
           .meaning = "what follows an overload: a line on standard error, or a fault for as long as it lasts",
           .words = overload_words},
    RunKey{.name = "scheduling",
           .kind = choice,
           .otherwise = "\"fifo\"",
           .meaning = "the scheduling that is asked for; the status line says what was obtained",
           .words = scheduling_words},
    RunKey{"priority", whole, "80", "of fifo", 1.0, 99.0},
    RunKey{"processor", whole, "(any)", "the processor that the task keeps to", 0.0, 1023.0},
    RunKey{"lock_memory", flag, "true", "no page of memory leaves while it runs"},
};
constexpr std::array watchdog_keys{
    RunKey{"time", time, "(no watchdog)", "the longest time of a cycle", us, 1000.0 * s},
    RunKey{"sensitivity", whole, "1", "so many cycles in a row may be longer; one may be longer by this factor", 1.0,
           1000.0},
    RunKey{"guard", flag, "true", "a process of its own holds the outputs on devices safe when the task hangs or dies"},
    RunKey{"silence",
           time,
           "\"50ms\"",
           "without a cycle for so long, the guard takes over",
           ms,
           1000.0 * s,
           {},
           "two periods at the least"},
    RunKey{"guard_wait", time, "\"60s\"",
           "a start waits so long for the guard of an earlier run, which brings a device to its safe values; then it "
           "ends that guard, and starts",
           ms, 86400.0 * s},
};
constexpr std::array output_keys{
    RunKey{"safe", number, "(required)", "the value of the output when something is wrong, in its unit"},
    RunKey{.name = "on_fault",
           .kind = choice,
           .otherwise = "\"value\"",
           .meaning = "how it gets there: at once, by a ramp, or not at all: it holds its last value",
           .words = on_fault_words},
    RunKey{"hold_cycles", whole, "0", "cycles for which it holds its last value before", 0.0, many},
    RunKey{"ramp", number, "(required by on_fault)", "of a ramp, the change a second", above_zero},
    RunKey{"low", number, "(the diagram's)", "the output is never below"},
    RunKey{"high", number, "(the diagram's)", "the output is never above"},
    RunKey{"slew", number, "(none)", "the largest change a second", above_zero},
    RunKey{"bump", number, "(1 % of `low` to `high`; where it has none of both, 0)",
           "at an online change: how far it may jump, in its unit", 0.0, many},
    RunKey{"device", text, "(none)", "the device that takes it, as named under [devices]"},
    RunKey{"register", whole, "0", "where it lies there: the first register, or the coil", 0.0, 65535.0},
    RunKey{.name = "area",
           .kind = choice,
           .otherwise = "\"holding\"",
           .meaning = "holding registers or coils",
           .words = written_area_words},
    type_key("(real64; of a coil or bit, boolean)",
             "how it lies there; an integer limits the output to what it can hold"),
    scale_key,
    offset_key,
    order_key("(the device's)"),
    RunKey{"bit", whole, "(none)",
           "of a holding register, 0 the lowest: a boolean; the register's bits that no output has are written as 0",
           0.0, 15.0},
    RunKey{.name = "on_loss",
           .kind = choice,
           .otherwise = "\"fault\"",
           .meaning = "where the device is lost: a fault of the task, or left to the diagram",
           .words = loss_words},
    RunKey{"longest_age",
           time,
           "(ten cycles of the device, or its timeout)",
           "on a device: it is lost once the device has not taken it for so long",
           1.0,
           1000.0 * s,
           {},
           "a period at the least"},
};
constexpr std::array input_keys{
    RunKey{"device", text, "(none: clients of the server write it)",
           "the device that gives it, as named under [devices]"},
    RunKey{"register", whole, "0", "where it lies there: the first register, coil or discrete input", 0.0, 65535.0},
    RunKey{.name = "area",
           .kind = choice,
           .otherwise = "\"holding\"",
           .meaning = "holding or input registers, coils or discrete inputs",
           .words = area_words},
    type_key("(real64; of a coil, discrete input or bit, boolean)", "how it lies there"),
    scale_key,
    offset_key,
    order_key("(the device's)"),
    RunKey{"bit", whole, "(none)", "of a register, 0 the lowest: a boolean", 0.0, 15.0},
    RunKey{.name = "on_loss",
           .kind = choice,
           .otherwise = "\"fault\"",
           .meaning = "where the device is lost: a fault of the task, or the last value stays",
           .words = loss_words},
    RunKey{"longest_age",
           time,
           "(on a device, ten of its cycles, or its timeout; else none)",
           "older, it is lost; written by clients, it is stale",
           1.0,
           1000.0 * s,
           {},
           "a period at the least"},
    RunKey{"retain", flag, "false", "written by clients: its value is kept through a restart, with [retain]"},
    RunKey{"age_of", text, "(none)", "it is told the age of this input or output on a device, in seconds"},
    RunKey{"quality_of", text, "(none)", "the same, the quality: 0 never, 1 good, 2 old, 3 refused, 4 lost"},
};
constexpr std::array device_keys{
    RunKey{"host", text, "\"127.0.0.1\"", "of Modbus TCP: name or address"},
    RunKey{"port", whole, "502", "of Modbus TCP", 1.0, 65535.0},
    RunKey{.name = "connection",
           .kind = choice,
           .otherwise = "\"own\"",
           .meaning =
               "of Modbus TCP: one of its own, or shared by the devices at this host and port that say so, as the "
               "units behind a gateway",
           .words = connection_words},
    RunKey{"serial", text, "(none: TCP)",
           "of Modbus RTU: the serial line, as /dev/ttyUSB0; devices on one line take turns"},
    baud_key,
    parity_key,
    stop_key,
    echo_key,
    RunKey{"unit",
           whole,
           "1",
           "the unit identifier; over TCP, many a device that is no gateway wants 255",
           0.0,
           255.0,
           {},
           "not 248 to 254; on a serial line 1 to 247"},
    RunKey{.name = "word_order",
           .kind = choice,
           .otherwise = "\"abcd\"",
           .meaning = "how values of 32 and 64 bits lie in its registers",
           .words = order_words},
    RunKey{"cycle", time, "\"5ms\"", "how often its values are exchanged", 100.0 * us, 3600.0 * s},
    RunKey{"timeout", time, "\"200ms\"", "for a whole answer, and for a connection", ms, 60.0 * s},
    RunKey{.name = "on_absence",
           .kind = choice,
           .otherwise = "\"fault\"",
           .meaning =
               "where it has never answered since the start: a fault of the task, as its loss is; or the task goes on "
               "without it, and it counts from its first answer on",
           .words = absence_words},
};
constexpr std::array retain_keys{
    RunKey{"folder", path, "(required)", "where the state and the parameters are kept"},
    RunKey{"every", time, "\"1s\"", "how often they are written; a whole number counts cycles", 1.0, 24.0 * 3600.0 * s},
    RunKey{.name = "mismatch",
           .kind = choice,
           .otherwise = "\"carry\"",
           .meaning =
               "where what was kept is of another diagram, or of this one before an edit: an error; put aside and "
               "begun anew; or carried over by name as far as name, type and unit are the same",
           .words = mismatch_words},
};
constexpr std::array trace_keys{
    RunKey{"file", path, "(required)", "the trace, for replay, tune and diagnose"},
    RunKey{"megabytes", whole, "1024", "what all its files take at most, together", 1.0, 1e9},
    RunKey{"files", whole, "8", "how many there are at most, of earlier runs too: run.trace, run.trace.1, …", 2.0,
           1000.0},
    RunKey{"trigger", text, "(none: every cycle is kept)",
           "\"U > 5.0\", an input or output and a number: fires as it crosses, not where it holds from the start; or "
           "\"fault\", which counts from the first cycle"},
    RunKey{"before",
           whole,
           "1000",
           "with a trigger: cycles kept from before, in memory until it fires",
           0.0,
           1e6,
           {},
           "256 MB of memory at the most"},
    RunKey{"after", whole, "1000", "with a trigger: cycles kept from then on", 0.0, many},
    RunKey{"captures",
           whole,
           "1",
           "with a trigger: it is armed again until it has fired so often; each time begins another file",
           1.0,
           1000.0,
           {},
           "`files` at the most"},
};
constexpr std::array online_change_keys{
    RunKey{"socket", path, "(required)",
           "the file of the socket on which the task of `hysteron serve` takes an online change from its own user; "
           "`hysteron online-change` finds it here"},
    RunKey{"load", number, "0.8", "of the period, what a step of a new version may take; longer, it is refused", 1e-3,
           1.0},
};
constexpr std::array history_keys{
    RunKey{"file", path, "(required)", "the file of the history, of SQLite; `hysteron history` exports it"},
    RunKey{"points", texts, "(all inputs and outputs)",
           "what is kept: inputs, outputs, parameters as `HYST.C1`, what the task says of itself as `task.fault` and "
           "of its devices as `device.NAME.timeouts`; the name of a vector is each of its elements"},
    RunKey{"every", time, "\"1s\"", "from row to row: a whole number of periods; for `tune` and `diagnose`, one period",
           1.0, 86400.0 * s},
    RunKey{"keep", time, "\"30d\"", "older rows are deleted", 60.0 * s, 10000.0 * 86400.0 * s},
    RunKey{"megabytes", whole, "1000", "what it takes on the disk at most: the oldest rows give way", 1.0, 1e6},
};
constexpr std::array mqtt_keys{
    RunKey{"broker", text, "(required)", "name or address of the MQTT broker"},
    RunKey{"port", whole, "(1883, with `ca` 8883)", "its port", 1.0, 65535.0},
    RunKey{"ca", path, "(none: in the clear)",
           "TLS: certificates in PEM that sign the broker's; of public ones, "
           "`/etc/ssl/certs/ca-certificates.crt`"},
    RunKey{"certificate", path, "(none)", "the client's certificate in PEM, where the broker asks for one"},
    RunKey{"key", path, "(none)", "its private key in PEM, without a password; its owner and group alone may read it"},
    RunKey{"user", text, "(none)", "the user name that is said to the broker"},
    RunKey{"password_file", path, "(none)",
           "a file with the user's password in one line; its owner and group alone may read it"},
    RunKey{"client_id", text, "(made up at each start)", "the client's name, of no other client of the broker"},
    RunKey{.name = "payload",
           .kind = choice,
           .otherwise = "\"json\"",
           .meaning = "what is published: JSON, or Sparkplug B as an edge node",
           .words = payload_words},
    RunKey{"topic", text, "(`hysteron/` and the diagram's name)",
           "of JSON: rows go to `TOPIC/data`, whether the task is online to `TOPIC/state`"},
    RunKey{"qos", whole, "1", "of JSON: the quality of service of rows; Sparkplug B prescribes its own", 0.0, 1.0},
    RunKey{"group", text, "(`hysteron`)", "of Sparkplug B: the group"},
    RunKey{"node", text, "(the diagram's name)", "of Sparkplug B: the edge node"},
    RunKey{"points", texts, "(all inputs and outputs)",
           "what is published: inputs, outputs, parameters as `HYST.C1`, what the task says of itself as `task.fault` "
           "and of its devices as `device.NAME.timeouts`; the name of a vector is each of its elements"},
    RunKey{"every", time, "\"1s\"", "from row to row: a whole number of periods", 1.0, 86400.0 * s},
    RunKey{"on_change", flag, "false", "a row has those points alone that changed, and there is none where none did"},
    RunKey{"refresh",
           time,
           "(60s, or `every` where that is longer)",
           "on change: a point that stays is published again after so long",
           1.0,
           86400.0 * s,
           {},
           "`every` at the least"},
    RunKey{"file", path, "(none: in memory alone)",
           "the file, of SQLite, of rows that have waited for a second: they outlive a power cut"},
    RunKey{"keep", time, "\"1d\"", "rows that wait for the broker for longer are lost", s, 1000.0 * 86400.0 * s},
    RunKey{"megabytes", whole, "64",
           "memory for rows that wait, at most, and with `file` about as much disk: the oldest give way", 1.0, 1e5},
};
constexpr std::array dead_band_keys{
    RunKey{
        "NAME", number, "(0: any change counts)",
        "with `on_change`: the point NAME has changed where it is further than this from what was last published, in "
        "its unit"},
};
constexpr std::array modbus_keys{
    RunKey{"listen", text, "\"127.0.0.1\"",
           "the address of the server; `\"off\"` with `[modbus_rtu]`, where it serves a serial line alone"},
    RunKey{"port", whole, "1502", "its port, with `[tls]` by default 802; 0: any that is free", 0.0, 65535.0},
    RunKey{"allow", texts, "[]", "the networks whose clients are served; none: all that reach the address"},
    RunKey{"connections", whole, "32", "clients at once", 1.0, 1000.0},
    RunKey{"connections_per_address", whole, "(a quarter of them)",
           "of one IPv4 address, or of the 64 bits that an IPv6 address begins with", 1.0, 1000.0},
    RunKey{"idle", time, "\"60s\"", "a client that asks nothing for so long loses its connection", 100.0 * ms,
           86400.0 * s},
    RunKey{"evict", time, "\"5s\"",
           "where no place is left, the client that has asked nothing for longest gives way, if it is so long at least",
           100.0 * ms, 86400.0 * s},
    RunKey{"read_only", flag, "false", "writes are refused"},
    RunKey{.name = "word_order",
           .kind = choice,
           .otherwise = "\"abcd\"",
           .meaning = "how values of 32 and 64 bits lie in the registers",
           .words = order_words},
    RunKey{.name = "map",
           .kind = choice,
           .otherwise = "\"compact\"",
           .meaning =
               "where points lie: without holes from address 0 on, or as in OpenPLC's `%QX`, `%IX`, `%IW`, `%QW`, "
               "`%MW`, `%MD`, `%ML`",
           .words = map_words},
    RunKey{"lock_file", path, "(none)", "keeps the addresses through edits of the diagram"},
    RunKey{"expose", texts, "(all points)",
           "the points on the map, as `hysteron map` lists them; `\"HYST.*\"` is all that begin with `HYST.`, `\"*\"` "
           "all"},
    RunKey{"discovery", flag, "true",
           "clients can read the map from holding register 40000 on, and by function 20; without it, points may lie "
           "there"},
    RunKey{.name = "heartbeat",
           .kind = choice,
           .otherwise = "\"off\"",
           .meaning = "the telegrams that show that the client lives",
           .words = heartbeat_words},
    RunKey{"heartbeat_time", time, "\"1s\"", "without one for so long after the first, the outputs become safe", ms,
           3600.0 * s},
    RunKey{.name = "after_loss",
           .kind = choice,
           .otherwise = "\"resume\"",
           .meaning = "the outputs return when the client is back, or when it then writes task.reset",
           .words = after_words},
    RunKey{"own_writes", flag, "false", "while a client that writes is there, no other may"},
};

constexpr std::array rtu_keys{
    RunKey{"serial", text, "(required)",
           "the serial line, as /dev/ttyUSB0; it is tried again for as long as it is not there"},
    baud_key,
    parity_key,
    stop_key,
    echo_key,
    RunKey{"unit", whole, "1", "which unit on the line this is", 1.0, 247.0},
    RunKey{"longest_gap", time, "(3.5 characters, 20ms at the least)",
           "bytes that come later than this begin a new frame; some adapters hand bytes over every 16 ms", ms, s},
    RunKey{"read_only", flag, "false", "writes on the line are refused"},
};

constexpr std::array tls_keys{
    RunKey{"certificate", path, "(required)",
           "the server's certificate, a file in PEM, with those behind it that lead to its root"},
    RunKey{"key", path, "(required)",
           "its private key in PEM, without a password; its owner and group alone may read it"},
    RunKey{"clients", path, "(required)",
           "certificates in PEM that sign those of clients, or clients' own; no other client is served"},
    RunKey{"without_role", texts, "[]", "what a client may do whose certificate names no role; as under `[roles]`"},
};
constexpr std::array role_keys{
    RunKey{"NAME", texts, "(may nothing)",
           "what the role NAME may do: `read` every value, write `inputs` and the heartbeat, write and commit "
           "`parameters`, `reset` the task; else the answer is exception 01"},
};

constexpr std::array web_keys{
    RunKey{"listen", text, "(none: no page, but for `--web`)",
           "address and port of the page, `\"127.0.0.1:8080\"`; a host that is generated with it has the page"},
    RunKey{"token_file", path, "(none: nobody changes anything)",
           "a file with the token of who may write, its owner's alone; `--web-token-file` counts before it"},
    RunKey{"read_token_file", path, "(none)",
           "a file with another token, of who may only read beyond the loopback; `--web-read-token-file` counts before "
           "it"},
    RunKey{
        "rights", texts, "[\"parameters\", \"reset\"]",
        "what the page may do for who has its token: stage and commit `parameters`, `reset` the task, `force` inputs"},
};

constexpr std::array address_keys{
    RunKey{"NAME", text, "(by the map and the lock file)",
           "where the point NAME lies, as `hysteron map` lists it: `\"%QX0.3\"`, `\"%IW7\"`, `\"%ML2\"` with OpenPLC's "
           "meaning, or an area and a number, `\"holding 16\"`"},
};

constexpr std::array register_keys{
    RunKey{"at", text, "(by the map and the lock file)",
           "its address, as under `[addresses]`; `\"holding 16.3\"` is a bit of a register, 0 the lowest"},
    type_key("(the point's)", "how it lies there; what the type does not reach is read as the nearest that it does"),
    scale_key,
    offset_key,
    order_key("(the server's)"),
};

constexpr std::array file_keys{RunKey{"task"},          RunKey{"watchdog"}, RunKey{"outputs"},    RunKey{"inputs"},
                               RunKey{"devices"},       RunKey{"retain"},   RunKey{"trace"},      RunKey{"history"},
                               RunKey{"online_change"}, RunKey{"mqtt"},     RunKey{"dead_bands"}, RunKey{"modbus"},
                               RunKey{"tls"},           RunKey{"roles"},    RunKey{"addresses"},  RunKey{"registers"},
                               RunKey{"modbus_rtu"},    RunKey{"web"}};

constexpr std::array tables{
    RunTable{"[task]", "How the cycle runs.", task_keys},
    RunTable{"[watchdog]", "What watches it.", watchdog_keys},
    RunTable{"[outputs.NAME]", "A table for each output of the diagram; the name of a vector is each of its elements.",
             output_keys},
    RunTable{
        "[inputs.NAME]",
        "A table for each input that is not only written by clients; the name of a vector is each of its elements.",
        input_keys},
    RunTable{"[devices.NAME]", "A Modbus device with inputs or outputs of the task.", device_keys},
    RunTable{"[retain]", "What is kept through a restart; without the table, nothing.", retain_keys},
    RunTable{"[trace]", "The record of the run; without the table, none.", trace_keys},
    RunTable{"[online_change]", "The diagram may change while the task runs; without the table, not.",
             online_change_keys},
    RunTable{"[history]", "Chosen points, kept for days; without the table, none.", history_keys},
    RunTable{"[mqtt]", "Chosen points, published to an MQTT broker; without the table, none.", mqtt_keys},
    RunTable{"[dead_bands]", "A line for each point of `[mqtt]` whose small changes are not published.",
             dead_band_keys},
    RunTable{"[web]", "The live page.", web_keys},
    RunTable{"[modbus]", "The Modbus server; without the table, none.", modbus_keys},
    RunTable{"[modbus_rtu]", "The map of `[modbus]` on a serial line as well, by Modbus RTU; without the table, not.",
             rtu_keys},
    RunTable{"[tls]", "Modbus/TCP Security instead of Modbus in the clear, with certificates on both sides.", tls_keys},
    RunTable{"[roles]", "A line for each role that the certificates of clients name.", role_keys},
    RunTable{"[addresses]", "A line for each point of the server whose address is given.", address_keys},
    RunTable{"[registers.NAME]", "A table for each point that lies on the server in another way than as its type.",
             register_keys},
};

}  // namespace

std::span<const RunTable> run_tables() {
  return tables;
}

std::span<const RunKey> top_keys() {
  return file_keys;
}

const RunTable& run_table(std::string_view name) {
  const auto* const found = std::ranges::find_if(
      tables, [&](const RunTable& table) { return table.name.substr(1, table.name.find_first_of(".]") - 1) == name; });
  if (found == tables.end()) {
    throw std::invalid_argument("there is no such table in a run file");
  }
  return *found;
}

}  // namespace hysteron::runtime
