#include "codegen/backends/fmu/wrapper.hpp"

namespace hysteron {

std::string_view fmu_core_types() {
  return R"(#if defined(_WIN32)
#define FMU_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define FMU_EXPORT __attribute__((visibility("default")))
#else
#define FMU_EXPORT
#endif

enum { KIND_REAL = 1, KIND_INT = 2, KIND_BOOL = 4, KIND_WORD = 8, KIND_TIME = 16 };
enum { ROLE_INPUT, ROLE_OUTPUT, ROLE_PARAMETER };
typedef enum { PHASE_NEW, PHASE_INITIALIZATION, PHASE_STEPS, PHASE_END } fmu_phase;

// All that an instance is, and what is saved of it.
typedef struct {
  fmu_params_type params;
  fmu_in_type in;
  fmu_state_type state;
  fmu_out_type out;
  double start;
  double stop;
  double reached;  // the communication point
  int64_t samples;  // how many have been
  bool has_stop;
  fmu_phase phase;
} fmu_values;

typedef struct {
  fmu_values values;
  fmu_logger logger;
} fmu_instance;

typedef struct {
  size_t place;
  size_t elements;
  int kind;
  int role;
  double minimum;
  double maximum;
  bool above_minimum;
} fmu_variable;

)";
}

std::string_view fmu_core() {
  return R"(static int fmu_refuse(const fmu_instance *instance, int status, const char *reason) {
  if (instance != NULL) {
    fmu_say(&instance->logger, status, reason);
  }
  return status;
}

static void fmu_restart(fmu_values *values) {
  memset(values, 0, sizeof(*values));
  FMU_DEFAULTS(&values->params, &values->in);
  FMU_RESET(&values->state, &values->params);
}

static bool fmu_same_text(const char *a, const char *b) {
  return a != NULL && strcmp(a, b) == 0;
}

static fmu_instance *fmu_new(const char *token, const fmu_logger *logger) {
  fmu_instance *instance;
  if (!fmu_same_text(token, FMU_TOKEN)) {
    fmu_say(logger, FMU_ERROR, "the token is not that of this binary: modelDescription.xml belongs to another");
    return NULL;
  }
  instance = (fmu_instance *)malloc(sizeof(*instance));
  if (instance != NULL) {
    instance->logger = *logger;
    fmu_restart(&instance->values);
  }
  return instance;
}

// --- variables ---

// Before the first sample an output is what that sample would give, and nothing moves on.
static void fmu_preview(fmu_values *values) {
  fmu_state_type state = values->state;
  if (values->phase != PHASE_STEPS) {
    FMU_RESET(&state, &values->params);
  }
  FMU_STEP(&values->params, &state, &values->in, &values->out);
}

static size_t fmu_size(const fmu_variable *variable) {
  switch (variable->kind) {
    case KIND_REAL:
      return sizeof(fmu_real_type);
    case KIND_INT:
      return sizeof(int32_t);
    case KIND_BOOL:
      return sizeof(bool);
    default:
      return sizeof(uint16_t);
  }
}

static double fmu_number(const fmu_values *values, const fmu_variable *variable, size_t element) {
  const void *place = (const char *)values + variable->place + element * fmu_size(variable);
  switch (variable->kind) {
    case KIND_REAL:
      return (double)*(const fmu_real_type *)place;
    case KIND_INT:
      return (double)*(const int32_t *)place;
    case KIND_BOOL:
      return *(const bool *)place ? 1.0 : 0.0;
    default:
      return (double)*(const uint16_t *)place;
  }
}

// How many numbers the variables are together: an array is as many as it has elements.
static size_t fmu_elements(const uint32_t references[], size_t count) {
  size_t elements = 0;
  size_t i;
  for (i = 0; i < count; ++i) {
    const uint32_t reference = references[i];
    elements += reference < 1u || reference > FMU_VARIABLES ? 1u : fmu_variables[reference - 1u].elements;
  }
  return elements;
}

static int fmu_get(fmu_instance *instance, uint32_t reference, size_t element, int kinds, double *value) {
  const fmu_variable *variable;
  if (reference == 0u && (kinds & KIND_TIME) != 0) {
    *value = instance->values.reached;
    return FMU_OK;
  }
  if (reference < 1u || reference > FMU_VARIABLES || (fmu_variables[reference - 1u].kind & kinds) == 0) {
    return fmu_refuse(instance, FMU_ERROR, "no variable of this type has this value reference");
  }
  variable = &fmu_variables[reference - 1u];
  if (variable->role == ROLE_OUTPUT && instance->values.samples == 0) {
    fmu_preview(&instance->values);
  }
  *value = fmu_number(&instance->values, variable, element);
  return FMU_OK;
}

static int fmu_set(fmu_instance *instance, uint32_t reference, size_t element, int kinds, double value) {
  const fmu_variable *variable;
  double held = value;
  void *place;
  if (reference < 1u || reference > FMU_VARIABLES || (fmu_variables[reference - 1u].kind & kinds) == 0) {
    return fmu_refuse(instance, FMU_ERROR, "no variable of this type has this value reference");
  }
  variable = &fmu_variables[reference - 1u];
  if (variable->role == ROLE_OUTPUT) {
    return fmu_refuse(instance, FMU_ERROR, "an output cannot be set");
  }
  if (instance->values.phase == PHASE_END) {
    return fmu_refuse(instance, FMU_ERROR, "nothing can be set behind the end");
  }
  if (variable->kind == KIND_REAL) {
    held = (double)(fmu_real_type)value;
  }
  if (variable->kind == KIND_WORD && !(value >= 0.0 && value <= 65535.0)) {
    return fmu_refuse(instance, FMU_DISCARD, "a WORD holds 0 to 65535");
  }
  if (variable->role == ROLE_PARAMETER &&
      !(held <= variable->maximum && (variable->above_minimum ? held > variable->minimum : held >= variable->minimum))) {
    return fmu_refuse(instance, FMU_DISCARD, "the parameter's value is out of its range");
  }
  place = (char *)&instance->values + variable->place + element * fmu_size(variable);
  switch (variable->kind) {
    case KIND_REAL:
      *(fmu_real_type *)place = (fmu_real_type)value;
      break;
    case KIND_INT:
      *(int32_t *)place = (int32_t)value;
      break;
    case KIND_BOOL:
      *(bool *)place = value != 0.0;
      break;
    default:
      *(uint16_t *)place = (uint16_t)value;
      break;
  }
  return FMU_OK;
}

// --- time ---

static bool fmu_is_finite(double value) {
  return value - value == 0.0;
}

static int fmu_begin(fmu_instance *instance, double start, bool has_stop, double stop) {
  if (!fmu_is_finite(start) || (has_stop && !(stop >= start))) {
    return fmu_refuse(instance, FMU_ERROR, "start and stop time contradict each other");
  }
  instance->values.start = start;
  instance->values.reached = start;
  instance->values.has_stop = has_stop;
  instance->values.stop = stop;
  return FMU_OK;
}

static int fmu_enter_initialization(fmu_instance *instance) {
  if (instance->values.phase != PHASE_NEW) {
    return fmu_refuse(instance, FMU_ERROR, "initialization begins once, behind the instantiation or a reset");
  }
  instance->values.phase = PHASE_INITIALIZATION;
  return FMU_OK;
}

static int fmu_exit_initialization(fmu_instance *instance) {
  fmu_values *values = &instance->values;
  if (values->phase != PHASE_INITIALIZATION) {
    return fmu_refuse(instance, FMU_ERROR, "there is no initialization to end");
  }
  FMU_RESET(&values->state, &values->params);
  values->phase = PHASE_STEPS;
  return FMU_OK;
}

static int fmu_end(fmu_instance *instance) {
  if (instance->values.phase != PHASE_STEPS) {
    return fmu_refuse(instance, FMU_ERROR, "only a run can be terminated");
  }
  instance->values.phase = PHASE_END;
  return FMU_OK;
}

// From `time` to `time + step`: the samples at start + k * period that lie at `time` or behind it, and before the end.
// A point within a millionth of a period of a sample counts as on it: sums of steps are rounded.
static int fmu_advance(fmu_instance *instance, double time, double step) {
  const double slack = 1e-6;
  fmu_values *values = &instance->values;
  const double end = time + step;
  const double due = ceil((end - values->start) / FMU_PERIOD - slack);
  if (values->phase != PHASE_STEPS) {
    return fmu_refuse(instance, FMU_ERROR, "a step needs an initialized instance");
  }
  if (!(step > 0.0) || !fmu_is_finite(end)) {
    return fmu_refuse(instance, FMU_ERROR, "a communication step is a number above 0");
  }
  if (!(fabs(time - values->reached) <= slack * FMU_PERIOD + 4e-16 * fabs(time))) {
    return fmu_refuse(instance, FMU_ERROR, "a step begins where the last one ended");
  }
  if (values->has_stop && end > values->stop + slack * FMU_PERIOD + 4e-16 * fabs(end)) {
    return fmu_refuse(instance, FMU_ERROR, "the step ends behind the stop time");
  }
  if (!(due < 9e15)) {
    return fmu_refuse(instance, FMU_ERROR, "more samples than can be counted");
  }
  while ((double)values->samples < due) {
    FMU_STEP(&values->params, &values->state, &values->in, &values->out);
    ++values->samples;
  }
  values->reached = end;
  return FMU_OK;
}

// --- the saved state: as a copy, and as bytes that tell whose they are ---

static int fmu_save(fmu_instance *instance, void **copy) {
  if (copy == NULL) {
    return fmu_refuse(instance, FMU_ERROR, "there is no place for the state");
  }
  if (*copy == NULL) {
    *copy = malloc(sizeof(fmu_values));
  }
  if (*copy == NULL) {
    return fmu_refuse(instance, FMU_ERROR, "no memory for the state");
  }
  memcpy(*copy, &instance->values, sizeof(fmu_values));
  return FMU_OK;
}

static int fmu_restore(fmu_instance *instance, const void *copy) {
  if (copy == NULL) {
    return fmu_refuse(instance, FMU_ERROR, "there is no state");
  }
  memcpy(&instance->values, copy, sizeof(fmu_values));
  return FMU_OK;
}

static size_t fmu_bytes(void) {
  return sizeof(uint64_t) + sizeof(FMU_TOKEN) + sizeof(fmu_values);
}

// FNV-1a: finds bytes that were cut or changed on their way.
static uint64_t fmu_sum(const uint8_t *bytes, size_t count) {
  uint64_t sum = 14695981039346656037u;
  size_t i;
  for (i = 0; i < count; ++i) {
    sum = (sum ^ bytes[i]) * 1099511628211u;
  }
  return sum;
}

static int fmu_write_bytes(const fmu_instance *instance, const void *copy, uint8_t *bytes, size_t size) {
  uint64_t sum;
  if (copy == NULL || bytes == NULL || size < fmu_bytes()) {
    return fmu_refuse(instance, FMU_ERROR, "the state does not fit into these bytes");
  }
  memcpy(bytes + sizeof(sum), FMU_TOKEN, sizeof(FMU_TOKEN));
  memcpy(bytes + sizeof(sum) + sizeof(FMU_TOKEN), copy, sizeof(fmu_values));
  sum = fmu_sum(bytes + sizeof(sum), fmu_bytes() - sizeof(sum));
  memcpy(bytes, &sum, sizeof(sum));
  return FMU_OK;
}

static int fmu_read_bytes(const fmu_instance *instance, const uint8_t *bytes, size_t size, void **copy) {
  uint64_t sum;
  if (bytes == NULL || copy == NULL || size != fmu_bytes()) {
    return fmu_refuse(instance, FMU_ERROR, "these bytes are no state of this model");
  }
  memcpy(&sum, bytes, sizeof(sum));
  if (memcmp(bytes + sizeof(sum), FMU_TOKEN, sizeof(FMU_TOKEN)) != 0 ||
      sum != fmu_sum(bytes + sizeof(sum), fmu_bytes() - sizeof(sum))) {
    return fmu_refuse(instance, FMU_ERROR, "these bytes are no state of this model");
  }
  if (*copy == NULL) {
    *copy = malloc(sizeof(fmu_values));
  }
  if (*copy == NULL) {
    return fmu_refuse(instance, FMU_ERROR, "no memory for the state");
  }
  memcpy(*copy, bytes + sizeof(sum) + sizeof(FMU_TOKEN), sizeof(fmu_values));
  return FMU_OK;
}

)";
}

}  // namespace hysteron
