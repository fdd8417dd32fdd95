// hysteron generate --host: the folder is whole or not there, builds with Debian's packages alone, and does what
// `hysteron serve` does: the same bits, registers and retained values.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "runtime/modbus/register_map.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/tool/workbench.hpp"
#include "tests/web/web_client.hpp"
#include "tool/host_sources.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* hosted_plant = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL := 1.25;  (* @unit V @min -5 @max 5 *)
    RESET : BOOL;
    COUNT : DINT := -3;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
    Z : LREAL;
    BUSY : BOOL;
    N : DINT;
  END_VAR
  VAR
    HYST : HY_HYSTERESIS_RO := (C1 := 1.5, C2 := 0.1, C3 := 0.7);
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);
    SUM : HY_INTEGRAL;
    BOUND : HY_LIMIT := (MN := -4.0);
  END_VAR

  HYST(XIN := X * WAVE.XOUT);
  SUM(XIN := WAVE.XOUT, R1 := RESET);
  Y := HYST.XOUT;
  BOUND(XIN := SUM.XOUT);
  Z := EXP(BOUND.XOUT * 0.5);
  BUSY := WAVE.XOUT > 1.0;
  WAVE();
  N := COUNT * 2;
END_FUNCTION_BLOCK
)";
constexpr const char* safe =
    "[outputs.Y]\nsafe = -1.0\n[outputs.Z]\nsafe = 1.0\n[outputs.BUSY]\nsafe = 0.0\n[outputs.N]\nsafe = 0.0\n";

/// A program of the shell that runs beside the test, in the folder of a workbench; ended with the test.
class Beside {
 public:
  Beside(const test::Workbench& bench, const std::string& line) {
    const auto bin = std::filesystem::path(HYSTERON_TOOL).parent_path().string();
    const std::string command =
        fmt::format("cd '{}' && PATH='{}':\"$PATH\" && echo $$ && exec {} 2>&1", bench.path().string(), bin, line);
    stream_ = ::popen(command.c_str(), "r");
    process_ = std::stoi(next_line());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  Beside(Beside&&) = delete;
  Beside& operator=(Beside&&) = delete;
  ~Beside() {
    if (stream_ != nullptr) {
      ::kill(process_, SIGKILL);
      ::pclose(stream_);
    }
  }

  std::string next_line() {
    std::string line;
    for (int letter = 0; (letter = std::fgetc(stream_)) != EOF && letter != '\n';) {
      line += static_cast<char>(letter);
    }
    return line;
  }
  /// Ends it by SIGTERM; its exit code. Nobody reads any more what it says at its end.
  int end() {
    ::kill(process_, SIGTERM);
    const int status = ::pclose(std::exchange(stream_, nullptr));
    return test::exit_code(status);
  }

 private:
  std::FILE* stream_ = nullptr;
  pid_t process_ = 0;
};

/// All that a client can learn of the registers: the identity, and the discovery chain.
std::string registers_of(std::uint16_t port) {
  const test::ClientSocket client(port);
  std::string all;
  const auto ask = [&](const test::Bytes& pdu) {
    test::Bytes frame{0, 1, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 1};
    frame.insert(frame.end(), pdu.begin(), pdu.end());
    client.send(frame);
    const test::Bytes answer = client.receive_frame();
    all.append(answer.begin(), answer.end()).append("\n");
    return answer.size() > 7 && answer[7] == pdu[0];
  };
  EXPECT_TRUE(ask({43, 14, 3, 0}));
  EXPECT_TRUE(ask({43, 14, 4, 0x80}));
  for (std::uint32_t at = runtime::modbus::chain_address;
       ask({3, static_cast<std::uint8_t>(at >> 8U), static_cast<std::uint8_t>(at & 0xFFU), 0, 1}); ++at) {
  }
  return all;
}

std::uint16_t port_in(const std::string& line, const std::string& of) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(line, match, std::regex(of + "127\\.0\\.0\\.1:([0-9]+)"))) << line;
  return match.empty() ? std::uint16_t{1} : static_cast<std::uint16_t>(std::stoi(match[1]));
}

TEST(GenerateHost, TheFolderHasTheStepTheSourcesTheUnitAndAReadme) {
  const test::Workbench bench;
  bench.write("plant.st", hosted_plant);
  bench.write("RUN.toml", std::string(safe) + "[retain]\nfolder = \"kept\"\n");
  const auto outcome = bench.shell("hysteron generate plant.st --host --config RUN.toml --out made/here");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            fmt::format("made/here/plant.hpp\nmade/here/plant_step.cpp\nmade/here/main.cpp\nmade/here/CMakeLists.txt\n"
                        "made/here/README.md\nmade/here/run.toml\nmade/here/hysteron-plant.service.in\n"
                        "made/here/Containerfile\nmade/here/package/postinst\nmade/here/package/prerm\n"
                        "made/here/package/postrm\n"
                        "made/here/hysteron: {} sources\n",
                        tool::host_sources().size()));
  for (const tool::EmbeddedSource& source : tool::host_sources()) {
    const auto original = test::contents_of(std::string(HYSTERON_SOURCE_DIR) + "/" + std::string(source.path));
    EXPECT_EQ(source.text, original) << source.path;
    const auto copy = bench.read("made/here/hysteron/" + std::string(source.path));
    EXPECT_TRUE(copy.ends_with(original)) << source.path;
    EXPECT_THAT(source.path, AllOf(Not(StartsWith("codegen/")), Not(StartsWith("tool/")), Not(StartsWith("blocks/"))));
  }
  EXPECT_TRUE(bench.read("made/here/run.toml").ends_with(bench.read("RUN.toml")));
  EXPECT_THAT(
      bench.read("made/here/main.cpp"),
      ContainsRegex("\\.relations = \\{\n +\\{\\.numbers = \\{\n +\\{\\.parameter = [0-9]+\\},\n +\\{\\.parameter = "
                    "[0-9]+\\}\\}\\}\\},\n"))
      << "a commit is judged there as by serve";
  EXPECT_LE(std::ranges::count(bench.read("made/here/README.md"), '\n'), 25);
  EXPECT_THAT(
      bench.read("made/here/Containerfile"),
      AllOf(HasSubstr("\nUSER 990\n"), HasSubstr("ENTRYPOINT [\"/usr/bin/plant_host\", \"/etc/hysteron-plant.toml\"]"),
            HasSubstr("libmodbus-dev"), Not(HasSubstr("{"))));
  EXPECT_THAT(bench.read("made/here/CMakeLists.txt"), Not(HasSubstr("Boost"))) << "who has no page needs none";
  EXPECT_THAT(bench.read("made/here/README.md"), Not(HasSubstr("libboost-dev")));
  const auto again = bench.shell("hysteron generate plant.st --host --config RUN.toml --out made/here --float32");
  EXPECT_EQ(again.code, 0) << "what was generated before is replaced: " << again.err;
}

TEST(GenerateHost, TheUnitHasTheRightsThatTheRunFileNeedsAndNoOther) {
  const test::Workbench bench;
  bench.write("plant.st", hosted_plant);
  const auto unit = [&](const std::string& rest) {
    bench.write("RUN.toml", safe + rest);
    const auto outcome = bench.shell("hysteron generate plant.st --host --config RUN.toml --out host --force");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return bench.read("host/hysteron-plant.service.in");
  };
  EXPECT_THAT(unit(""), AllOf(HasSubstr("\nType=notify\n"), HasSubstr("\nWatchdogSec="),
                              HasSubstr("\nStartLimitIntervalSec=0\n"), HasSubstr("\nDynamicUser=yes\n"),
                              HasSubstr("\nNoNewPrivileges=yes\n"), HasSubstr("\nProtectSystem=strict\n"),
                              HasSubstr("\nKillMode=control-group\n"), HasSubstr("\nRestart=on-failure\n"),
                              HasSubstr("\nLimitRTPRIO=80\nLimitMEMLOCK=infinity\nCapabilityBoundingSet=\n"),
                              HasSubstr("\nPrivateDevices=yes\n"), Not(HasSubstr("ReadWritePaths"))));
  EXPECT_THAT(unit(""), HasSubstr("\nTimeoutStopSec=15\n"));
  EXPECT_THAT(unit("on_fault = \"ramp\"\nramp = 0.5\nlow = -10.0\nhigh = 20.0\nhold_cycles = 3000\n"),
              HasSubstr("\nTimeoutStopSec=58\n"))
      << "3 s of hold, 40 s for the longer way, 10 s for devices, and 5";
  EXPECT_THAT(unit("on_fault = \"ramp\"\nramp = 0.5\n"), HasSubstr("\nTimeoutStopSec=infinity\n"));
  EXPECT_THAT(unit("[task]\nscheduling = \"other\"\nlock_memory = false\n"),
              AllOf(Not(HasSubstr("LimitRTPRIO")), Not(HasSubstr("LimitMEMLOCK"))));
  EXPECT_THAT(unit("[task]\nscheduling = \"deadline\"\n[modbus]\nport = 502\n"),
              AllOf(HasSubstr("\nCapabilityBoundingSet=CAP_SYS_NICE CAP_NET_BIND_SERVICE\nAmbientCapabilities=CAP_SYS_"
                              "NICE CAP_NET_BIND_SERVICE\n"),
                    Not(HasSubstr("LimitRTPRIO"))));
  EXPECT_THAT(
      unit("[devices.stage]\nserial = \"/dev/ttyUSB3\"\n[inputs.X]\ndevice = \"stage\"\n"
           "[retain]\nfolder = \"/srv/kept\"\n[trace]\nfile = \"/srv/traces/run.trace\"\n"),
      AllOf(
          HasSubstr("\nDevicePolicy=closed\nSupplementaryGroups=dialout\nDeviceAllow=/dev/ttyUSB3 rw\n"),
          HasSubstr("\n#   useradd --system --no-create-home hysteron-plant\n"
                    "#   install -d -o hysteron-plant \"/srv/kept\"\n#   install -d -o hysteron-plant \"/srv/traces\"\n"
                    "ReadWritePaths=-/srv/kept\nReadWritePaths=-/srv/traces\n"),
          Not(HasSubstr("PrivateDevices"))));
  EXPECT_THAT(unit("[modbus]\n[tls]\ncertificate = \"server.pem\"\nkey = \"/etc/my keys/server.key\"\n"
                   "clients = \"/etc/ssl/clients.pem\"\n[roles]\noperator = [\"read\"]\n"),
              AllOf(HasSubstr("\nAmbientCapabilities=CAP_NET_BIND_SERVICE\n"),
                    HasSubstr("\nLoadCredential=\"tls-key:/etc/my keys/server.key\"\n"
                              "LoadCredential=tls-clients:/etc/ssl/clients.pem\n"),
                    Not(HasSubstr("tls-certificate"))));
  EXPECT_THAT(
      unit("[mqtt]\nbroker = \"b\"\nca = \"/etc/ssl/ca.pem\"\nuser = \"stage\"\npassword_file = \"/etc/stage/word\"\n"),
      AllOf(HasSubstr("\nLoadCredential=mqtt-ca:/etc/ssl/ca.pem\n"
                      "LoadCredential=mqtt-password:/etc/stage/word\n"),
            Not(HasSubstr("mqtt-key"))));
  EXPECT_THAT(unit("[trace]\nfile = \"/srv/my runs/100%/run.trace\"\n"),
              HasSubstr("\nReadWritePaths=\"-/srv/my runs/100%%\"\n"));
}

TEST(GenerateHost, NothingIsWrittenWhereSomethingIsWrong) {
  const test::Workbench bench;
  bench.write("plant.st", hosted_plant);
  bench.write("RUN.toml", safe);
  bench.write("unsafe.toml", "[outputs.Y]\nsafe = 0.0\n");
  bench.write("own/main.cpp", "int main() {}\n");
  bench.write("blocked/hysteron/runtime/host/host.cpp/in_the_way", "");
  const auto before = bench.names();
  const auto refused = [&](const std::string& options, const std::string& said) {
    const auto outcome = bench.shell("hysteron generate plant.st " + options);
    EXPECT_EQ(outcome.code, 2) << options;
    EXPECT_THAT(outcome.err, HasSubstr(said)) << options;
    EXPECT_EQ(bench.names(), before) << options;
  };
  refused("--out g", "HY730 error: It is not said what to generate.");
  refused("--host --out g", "HY730 error: A host needs its run file.");
  refused("--target cpp --config RUN.toml --out g", "HY730 error: A run file is for a host");
  refused("--host --config missing.toml --out g", "HY100");
  refused("--host --config unsafe.toml --out g", "HY806");
  refused("--host --config RUN.toml --out own", "HY731");
  refused("--host --config RUN.toml --out blocked", "HY700");
  bench.write("run.toml", safe);
  EXPECT_EQ(bench.shell("hysteron generate plant.st --host --config run.toml --out .").code, 2) << "HY709";
}

TEST(GenerateHost, WhereTheRunFileNamesAnAddressItHasTheLivePage) {
  const test::Workbench bench;
  bench.write("plant.st", hosted_plant);
  bench.write("RUN.toml", std::string(safe) +
                              "[web]\nlisten = \"127.0.0.1:80\"\ntoken_file = \"/etc/stage/token\"\n"
                              "read_token_file = \"read-token\"\nrights = [\"parameters\", \"force\"]\n");
  const auto outcome = bench.shell("hysteron generate plant.st --host --config RUN.toml --out host");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const tool::EmbeddedSource& source : tool::page_sources()) {
    const auto original = test::contents_of(std::string(HYSTERON_SOURCE_DIR) + "/" + std::string(source.path));
    EXPECT_EQ(source.text, original) << source.path;
    EXPECT_TRUE(bench.read("host/hysteron/" + std::string(source.path)).ends_with(original)) << source.path;
  }
  EXPECT_THAT(bench.read("host/CMakeLists.txt"),
              AllOf(HasSubstr("find_package(Boost 1.74 REQUIRED)\n"), HasSubstr(" Boost::headers)"),
                    HasSubstr("\n  hysteron/runtime/web/assets.cpp")));
  EXPECT_THAT(bench.read("host/README.md"), HasSubstr(" libboost-dev\n"));
  EXPECT_THAT(bench.read("host/main.cpp"),
              AllOf(HasSubstr("page_of_run_file"), HasSubstr(".picture = \"<svg "), HasSubstr("\"HYST.XOUT\"")));
  EXPECT_THAT(bench.read("host/hysteron/runtime/web/assets.cpp"),
              AllOf(HasSubstr("<!DOCTYPE html>"), HasSubstr("Asset{\"/dygraph.js\"")));
  EXPECT_THAT(bench.read("host/hysteron-plant.service.in"),
              AllOf(HasSubstr("\nAmbientCapabilities=CAP_NET_BIND_SERVICE\n"),
                    HasSubstr("\nLoadCredential=web-token:/etc/stage/token\n"), Not(HasSubstr("web-read-token"))));
  bench.write("RUN.toml", std::string(safe) + "[web]\nlisten = \"everywhere\"\n");
  EXPECT_THAT(bench.shell("hysteron generate plant.st --host --config RUN.toml --out other").err, HasSubstr("HY842"));
}

/// Built once, for all that follows: that takes a minute.
TEST(GenerateHost, BuiltItHasTheBitsTheRegistersAndTheRetainedValuesOfServe) {
  const test::Workbench bench;
  bench.write("plant.st", hosted_plant);
  bench.write("p.toml", "[parameters.HYST]\nC1 = 1.75\n");
  bench.write("RUN.toml", std::string(safe) +
                              "[task]\nscheduling = \"other\"\nlock_memory = false\n[modbus]\nport = 0\n"
                              "lock_file = \"registers.lock\"\n[retain]\nfolder = \"kept\"\nevery = 100\n"
                              "[trace]\nfile = \"run.trace\"\n[web]\nlisten = \"127.0.0.1:0\"\n");
  bench.write("registers.lock", "holding 40 real64 X\nholding 60 real64 OF_A_PARAMETER_THAT_IS_GONE\n");
  const std::string diagram = "plant.st --params p.toml --config RUN.toml";
  ASSERT_EQ(bench.shell("hysteron generate " + diagram + " --host --out host").code, 0);
  // Without optimisation, which changes no bit; a compiler cache helps where there is one.
  const auto built = bench.shell(
      "if command -v ccache > where; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD "
      "CCACHE_NOHASHDIR=1; fi\n"
      "cmake -S host -B build -DCMAKE_BUILD_TYPE=None -DCMAKE_INSTALL_PREFIX=$PWD/stage && cmake --build build -j2 && "
      "cmake --install build");
  ASSERT_EQ(built.code, 0) << built.err << built.out;
  EXPECT_THAT(built.err, Not(HasSubstr("warning:")));
  EXPECT_THAT(bench.read("host/CMakeLists.txt"), HasSubstr("-Wno-restrict")) << "with optimisation GCC warns falsely";

  // The two runs in folders of their own: the same trace, retained state and addresses, and all but the same words.
  const auto run = [&](const std::string& folder, const std::string& program) {
    const auto outcome = bench.shell("mkdir -p " + folder + " && cp plant.st p.toml RUN.toml registers.lock " + folder +
                                     " && cd " + folder + " && " + program + " --virtual --cycles 20000");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return std::regex_replace(outcome.out, std::regex("late: .* in cycle [0-9]+|:[0-9]+[;/]"), "");
  };
  const auto served = run("serve", "hysteron serve " + diagram + " --engine compiled");
  const auto hosted = run("hosted", "../stage/bin/plant_host RUN.toml");
  EXPECT_EQ(std::regex_replace(hosted, std::regex("generated"), "compiled"), served);
  EXPECT_THAT(bench.read("serve/run.trace").size(), testing::Gt(20000U * 8U * 7U));
  for (const char* const file : {"run.trace", "registers.lock"}) {
    EXPECT_TRUE(bench.read(std::string("serve/") + file) == bench.read(std::string("hosted/") + file)) << file;
  }
  EXPECT_THAT(
      bench.shell("cd hosted && hysteron replay plant.st --params p.toml --trace run.trace --engine compiled").out,
      StartsWith("20000 steps replayed, 0 with other bits;"));
  // Each goes on from what the other one retained.
  EXPECT_THAT(run("serve", "../stage/bin/plant_host RUN.toml"), HasSubstr("generated, from retained state "));
  EXPECT_THAT(run("hosted", "hysteron serve " + diagram + " --engine compiled"), HasSubstr(", from retained state "));
  EXPECT_TRUE(bench.read("serve/run.trace") == bench.read("hosted/run.trace"));

  // Over Modbus, in real time; and without the lock file, as on a new machine.
  EXPECT_EQ(bench.shell("rm hosted/registers.lock").code, 0);
  std::map<std::string, std::string> seen;
  std::map<std::string, std::string> shown;
  for (const std::string program : {"env -C serve hysteron serve plant.st --params p.toml --config RUN.toml",
                                    "env -C hosted ../stage/bin/plant_host RUN.toml"}) {
    Beside beside(bench, program);
    std::string line = beside.next_line();
    if (line.starts_with("Start: nothing is there yet of registers.lock")) {  // it was removed above
      line = beside.next_line();
    }
    seen[program] = registers_of(port_in(line, "Modbus on "));
    EXPECT_GT(seen[program].size(), 1000U);
    const test::WebClient page(port_in(line, "live page on http://"));
    shown[program] = page.ask("GET", "/api/description").body;
    EXPECT_THAT(shown[program], AllOf(HasSubstr("HYST.XOUT"), HasSubstr("<svg ")));
    for (const char* const file : {"/", "/page.js", "/dygraph.js"}) {
      EXPECT_GT(page.ask("GET", file).body.size(), 1000U) << file;
    }
    EXPECT_EQ(beside.end(), 0) << program;
  }
  EXPECT_TRUE(seen.begin()->second == seen.rbegin()->second);
  EXPECT_EQ(shown.begin()->second, shown.rbegin()->second) << "the same page";

  // The unit, its paths filled in.
  const auto unit = bench.read("stage/lib/systemd/system/hysteron-plant.service");
  EXPECT_THAT(unit, ContainsRegex("\nExecStart=/.*/stage/bin/plant_host /.*/stage/etc/hysteron-plant.toml\n"));
  if (bench.shell("command -v systemd-analyze").code == 0) {
    const auto verified = bench.shell("systemd-analyze verify stage/lib/systemd/system/hysteron-plant.service");
    EXPECT_EQ(verified.code, 0) << verified.err;
    EXPECT_EQ(verified.err, "");
  }
  bench.write("stage/etc/hysteron-plant.toml", "# edited on the machine\n");
  EXPECT_EQ(bench.shell("cmake --install build").code, 0);
  EXPECT_EQ(bench.read("stage/etc/hysteron-plant.toml"), "# edited on the machine\n");

  // A package of Debian, where it is asked for: cpack builds everything a second time.
  if (std::getenv("HYSTERON_TEST_HOST_PACKAGE") != nullptr) {
    const auto packed =
        bench.shell("cmake -DCMAKE_INSTALL_PREFIX=/usr -DPACKAGE_VERSION=7.1 build && cd build && cpack");
    ASSERT_EQ(packed.code, 0) << packed.out << packed.err;
    const std::string package = "build/hysteron-plant_7.1_*.deb";
    const auto contents = bench.shell("dpkg-deb --contents " + package).out;
    for (const char* const file : {" ./usr/bin/plant_host\n", " ./usr/lib/systemd/system/hysteron-plant.service\n",
                                   " ./etc/hysteron-plant.toml\n"}) {
      EXPECT_THAT(contents, HasSubstr(file));
    }
    EXPECT_THAT(contents, Not(HasSubstr("/usr/local")));
    EXPECT_EQ(bench.shell("dpkg-deb --info " + package + " conffiles").out, "/etc/hysteron-plant.toml\n");
    EXPECT_THAT(bench.shell("dpkg-deb --field " + package).out,
                AllOf(HasSubstr("Package: hysteron-plant\n"), HasSubstr("libmodbus5"), HasSubstr("libssl3")));
    const auto unit_of_package = bench.shell("dpkg-deb --fsys-tarfile " + package +
                                             " | tar -xO ./usr/lib/systemd/system/hysteron-plant.service");
    EXPECT_THAT(unit_of_package.out, HasSubstr("\nExecStart=/usr/bin/plant_host /etc/hysteron-plant.toml\n"));
  }
}

}  // namespace
}  // namespace hysteron
