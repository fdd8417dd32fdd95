// An FMU of FMI 2.0 that does what is asked of it, also what no FMU should: written in C, compiled where it is tested.
// It has no state that can be saved, and names that are no identifiers.
#pragma once

#include <fmt/format.h>
#include <zip.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::test {

/// y integrates gain·u; motor.count counts; `mode` says what happens in the step from `moment` on.
inline constexpr std::string_view model_xml = R"xml(<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="Motor" guid="{motor}" description="a motor of the tests">
  <CoSimulation modelIdentifier="motor" canHandleVariableCommunicationStepSize="false"/>
  <TypeDefinitions>
    <SimpleType name="Torque"><Real unit="N.m" min="-5" max="5"/></SimpleType>
  </TypeDefinitions>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="1" causality="input"><Real declaredType="Torque" start="0"/></ScalarVariable>
    <ScalarVariable name="motor.n" valueReference="2" causality="input"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="on" valueReference="3" causality="input"><Boolean start="false"/></ScalarVariable>
    <ScalarVariable name="gain" valueReference="4" causality="parameter" variability="fixed" description="of the motor">
      <Real start="2" min="0" max="100" unit="rad/(N.m.s)"/></ScalarVariable>
    <ScalarVariable name="mode" valueReference="5" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="moment" valueReference="6" causality="parameter" variability="tunable"><Real start="0.002"/></ScalarVariable>
    <ScalarVariable name="label" valueReference="7" causality="parameter"><String start="motor"/></ScalarVariable>
    <ScalarVariable name="y" valueReference="8" causality="output"><Real unit="rad"/></ScalarVariable>
    <ScalarVariable name="motor.count" valueReference="9" causality="output"><Integer/></ScalarVariable>
    <ScalarVariable name="on_now" valueReference="10" causality="output"><Boolean/></ScalarVariable>
    <ScalarVariable name="y_" valueReference="8" causality="output"><Real/></ScalarVariable>
    <ScalarVariable name="STEP" valueReference="8" causality="output"><Real/></ScalarVariable>
  </ModelVariables>
  <ModelStructure/>
</fmiModelDescription>
)xml";

inline constexpr std::string_view model_source = R"c(
#include <math.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
  double u, gain, moment, y;
  int n, on, mode, count;
  logger log;
  void *environment;
} motor;

typedef struct {
  logger log;
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void *finished;
  void *environment;
} callbacks;

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const callbacks *given,
                      int visible, int logging) {
  motor *m;
  FILE *file;
  if (strcmp(guid, "{motor}") != 0 || type != 1 || strncmp(resources, "file:///", 8) != 0) {
    return NULL;
  }
  file = fopen(strstr(resources, "/resources") == NULL ? "none" : "start.txt", "r");
  m = given->allocate(1, sizeof(motor));
  m->gain = 2.0;
  m->moment = 0.002;
  m->log = given->log;
  m->environment = given->environment;
  if (file != NULL) {
    if (fscanf(file, "%lf", &m->y) != 1) {
      m->y = -1.0;
    }
    fclose(file);
  }
  return m;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int defined, double tolerance, double start, int stops, double stop) { return 0; }
int fmi2EnterInitializationMode(void *c) {
  motor *m = c;
  if (m->gain == 2.0) {
    printf("the motor prints\n");
    fflush(stdout);
  }
  if (m->mode == 6) {
    m->log(m->environment, "motor", 3, "init", "no start for gain %g", m->gain);
    return 3;
  }
  return 0;
}
int fmi2ExitInitializationMode(void *c) { return 0; }
int fmi2DoStep(void *c, double time, double step, int last) {
  motor *m = c;
  if (time >= m->moment - 1e-9) {
    switch (m->mode) {
      case 1: raise(SIGSEGV); break;
      case 2: for (;;) { usleep(1000); }
      case 3: return 2;
      case 4: m->log(m->environment, "motor", 3, "solver", "no convergence at u = %g", m->u); return 3;
      case 5: exit(7);
      case 7: m->y = NAN; return 0;
      case 8: if (m->gain > 3.0) { return 2; } break;
      case 9: m->log(m->environment, "motor", 1, "solver", "a warning"); break;
    }
  }
  m->y += step * m->gain * (m->u + m->n);
  ++m->count;
  return m->mode == 9 ? 1 : 0;
}
int fmi2SetReal(void *c, const unsigned r[], size_t n, const double v[]) {
  motor *m = c;
  size_t i;
  for (i = 0; i < n; ++i) {
    if (r[i] == 1) { m->u = v[i]; } else if (r[i] == 4) { m->gain = v[i]; } else if (r[i] == 6) { m->moment = v[i]; } else { return 3; }
  }
  return 0;
}
int fmi2GetReal(void *c, const unsigned r[], size_t n, double v[]) {
  size_t i;
  for (i = 0; i < n; ++i) {
    if (r[i] != 8) { return 3; }
    v[i] = ((motor *)c)->y;
  }
  return 0;
}
int fmi2SetInteger(void *c, const unsigned r[], size_t n, const int v[]) {
  motor *m = c;
  size_t i;
  for (i = 0; i < n; ++i) {
    if (r[i] == 2) { m->n = v[i]; } else if (r[i] == 5) { m->mode = v[i]; } else { return 3; }
  }
  return 0;
}
int fmi2GetInteger(void *c, const unsigned r[], size_t n, int v[]) {
  v[0] = ((motor *)c)->count;
  return n == 1 && r[0] == 9 ? 0 : 3;
}
int fmi2SetBoolean(void *c, const unsigned r[], size_t n, const int v[]) {
  ((motor *)c)->on = v[0];
  return n == 1 && r[0] == 3 && (v[0] == 0 || v[0] == 1) ? 0 : 3;
}
int fmi2GetBoolean(void *c, const unsigned r[], size_t n, int v[]) {
  v[0] = ((motor *)c)->on;
  return n == 1 && r[0] == 10 ? 0 : 3;
}
)c";

/// The bytes of the binary, compiled once.
inline const std::string& model_binary() {
  static const std::string bytes = [] {
    const ScratchFolder folder;
    const std::string source = folder.write("motor.c", model_source);
    const std::string target = source.substr(0, source.size() - 2) + ".so";
    if (std::system(fmt::format("cc -std=gnu99 -O1 -fPIC -shared '{}' -o '{}'", source, target).c_str()) != 0) {
      throw std::runtime_error("the FMU of the tests does not compile");
    }
    return contents_of(target);
  }();
  return bytes;
}

/// An archive with these files.
inline void write_archive(const std::filesystem::path& path, const std::map<std::string, std::string>& files) {
  int problem = 0;
  zip_t* const archive = zip_open(path.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &problem);
  for (const auto& [name, contents] : files) {
    zip_source_t* const source = zip_source_buffer(archive, contents.data(), contents.size(), 0);
    if (zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) < 0) {
      throw std::runtime_error("no archive");
    }
  }
  if (zip_close(archive) != 0) {
    throw std::runtime_error("no archive");
  }
}

inline void write_motor(const std::filesystem::path& path, std::string_view xml = model_xml) {
  write_archive(path, {{"modelDescription.xml", std::string(xml)}, {"binaries/linux64/motor.so", model_binary()}});
}

}  // namespace hysteron::test
