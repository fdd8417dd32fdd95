#include "codegen/backends/fmu/wrapper.hpp"

namespace hysteron {

std::string_view fmi3_declarations() {
  return R"(// With FMI3_FUNCTION_PREFIX, several models can be linked into one program.
#define FMU_JOINED(prefix, name) prefix##name
#define FMU_PREFIXED(prefix, name) FMU_JOINED(prefix, name)
#if defined(FMI3_FUNCTION_PREFIX)
#define FMI(name) FMU_PREFIXED(FMI3_FUNCTION_PREFIX, fmi3##name)
#else
#define FMI(name) fmi3##name
#endif

typedef void *fmi3Instance;
typedef uint32_t fmi3ValueReference;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessage)(void *environment, fmi3Status status, const char *category, const char *message);
typedef void (*fmi3IntermediateUpdate)(void *environment, double time, bool set_requested, bool get_allowed,
                                       bool step_finished, bool can_return_early, bool *returns_early,
                                       double *early_time);

enum { FMU_OK = fmi3OK, FMU_DISCARD = fmi3Discard, FMU_ERROR = fmi3Error };

typedef struct {
  fmi3LogMessage message;
  void *environment;
} fmu_logger;

static void fmu_say(const fmu_logger *logger, int status, const char *text) {
  if (logger->message != NULL) {
    logger->message(logger->environment, (fmi3Status)status, "logStatusError", text);
  }
}

)";
}

namespace {

constexpr std::string_view fmi3_life = R"(// --- FMI 3.0 ---

FMU_EXPORT const char *FMI(GetVersion)(void) {
  return "3.0";
}

FMU_EXPORT fmi3Status FMI(SetDebugLogging)(fmi3Instance instance, bool on, size_t count, const char *const names[]) {
  size_t i;
  if (instance == NULL || (count > 0 && names == NULL)) {
    return fmi3Error;
  }
  (void)on;  // only refusals are logged, and always
  for (i = 0; i < count; ++i) {
    if (!fmu_same_text(names[i], "logStatusError")) {
      return (fmi3Status)fmu_refuse((fmu_instance *)instance, FMU_ERROR, "the only log category is logStatusError");
    }
  }
  return fmi3OK;
}

FMU_EXPORT fmi3Instance FMI(InstantiateCoSimulation)(const char *name, const char *token, const char *resources,
                                                     bool visible, bool logging, bool event_mode, bool early_return,
                                                     const fmi3ValueReference intermediate[], size_t count,
                                                     void *environment, fmi3LogMessage message,
                                                     fmi3IntermediateUpdate update) {
  fmu_logger logger;
  logger.message = message;
  logger.environment = environment;
  if (event_mode || count > 0) {
    fmu_say(&logger, FMU_ERROR, "there is no event mode, and no intermediate value");
    return NULL;
  }
  return fmu_new(token, &logger);
}

FMU_EXPORT fmi3Instance FMI(InstantiateModelExchange)(const char *name, const char *token, const char *resources,
                                                      bool visible, bool logging, void *environment,
                                                      fmi3LogMessage message) {
  return NULL;
}

FMU_EXPORT fmi3Instance FMI(InstantiateScheduledExecution)(const char *name, const char *token, const char *resources,
                                                           bool visible, bool logging, void *environment,
                                                           fmi3LogMessage message, void (*clock_update)(void *),
                                                           void (*lock)(void), void (*unlock)(void)) {
  return NULL;
}

FMU_EXPORT void FMI(FreeInstance)(fmi3Instance instance) {
  free(instance);
}

FMU_EXPORT fmi3Status FMI(EnterInitializationMode)(fmi3Instance instance, bool tolerance_defined, double tolerance,
                                                   double start, bool stop_defined, double stop) {
  fmi3Status status;
  if (instance == NULL) {
    return fmi3Error;
  }
  status = (fmi3Status)fmu_enter_initialization((fmu_instance *)instance);
  return status != fmi3OK ? status : (fmi3Status)fmu_begin((fmu_instance *)instance, start, stop_defined, stop);
}

FMU_EXPORT fmi3Status FMI(ExitInitializationMode)(fmi3Instance instance) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_exit_initialization((fmu_instance *)instance);
}

FMU_EXPORT fmi3Status FMI(Terminate)(fmi3Instance instance) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_end((fmu_instance *)instance);
}

FMU_EXPORT fmi3Status FMI(Reset)(fmi3Instance instance) {
  if (instance == NULL) {
    return fmi3Error;
  }
  fmu_restart(&((fmu_instance *)instance)->values);
  return fmi3OK;
}

FMU_EXPORT fmi3Status FMI(DoStep)(fmi3Instance instance, double time, double step, bool no_return_before,
                                  bool *event, bool *terminate, bool *early, double *last_time) {
  fmi3Status status;
  if (instance == NULL || event == NULL || terminate == NULL || early == NULL || last_time == NULL) {
    return fmi3Error;
  }
  status = (fmi3Status)fmu_advance((fmu_instance *)instance, time, step);
  *event = false;
  *terminate = false;
  *early = false;
  *last_time = ((fmu_instance *)instance)->values.reached;
  return status;
}

FMU_EXPORT fmi3Status FMI(GetFMUState)(fmi3Instance instance, void **state) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_save((fmu_instance *)instance, state);
}

FMU_EXPORT fmi3Status FMI(SetFMUState)(fmi3Instance instance, void *state) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_restore((fmu_instance *)instance, state);
}

FMU_EXPORT fmi3Status FMI(FreeFMUState)(fmi3Instance instance, void **state) {
  if (state != NULL) {
    free(*state);
    *state = NULL;
  }
  return fmi3OK;
}

FMU_EXPORT fmi3Status FMI(SerializedFMUStateSize)(fmi3Instance instance, void *state, size_t *size) {
  if (instance == NULL || size == NULL) {
    return fmi3Error;
  }
  *size = fmu_bytes();
  return fmi3OK;
}

FMU_EXPORT fmi3Status FMI(SerializeFMUState)(fmi3Instance instance, void *state, uint8_t bytes[], size_t size) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_write_bytes((fmu_instance *)instance, state, bytes, size);
}

FMU_EXPORT fmi3Status FMI(DeserializeFMUState)(fmi3Instance instance, const uint8_t bytes[], size_t size,
                                               void **state) {
  return instance == NULL ? fmi3Error : (fmi3Status)fmu_read_bytes((fmu_instance *)instance, bytes, size, state);
}

// --- variables of the types that the model has; of others there is none, which the table tells ---

#define FMU_ACCESS(Name, Number, kinds)                                                                           \
  FMU_EXPORT fmi3Status FMI(Get##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,\
                                       Number values[], size_t value_count) {                                     \
    fmi3Status worst = fmi3OK;                                                                                    \
    size_t at = 0;                                                                                                \
    size_t i;                                                                                                     \
    size_t k;                                                                                                     \
    if (instance == NULL || (count > 0 && (references == NULL || values == NULL)) ||                              \
        fmu_elements(references, count) != value_count) {                                                         \
      return fmi3Error;                                                                                           \
    }                                                                                                             \
    for (i = 0; i < count; ++i) {                                                                                 \
      const size_t elements = fmu_elements(&references[i], 1);                                                    \
      for (k = 0; k < elements && worst == fmi3OK; ++k) {                                                         \
        double value = 0.0;                                                                                       \
        worst = (fmi3Status)fmu_get((fmu_instance *)instance, references[i], k, kinds, &value);                   \
        if (worst == fmi3OK) {                                                                                    \
          values[at++] = (Number)value;                                                                           \
        }                                                                                                         \
      }                                                                                                           \
    }                                                                                                             \
    return worst;                                                                                                 \
  }                                                                                                               \
                                                                                                                  \
  FMU_EXPORT fmi3Status FMI(Set##Name)(fmi3Instance instance, const fmi3ValueReference references[], size_t count,\
                                       const Number values[], size_t value_count) {                               \
    fmi3Status worst = fmi3OK;                                                                                    \
    size_t at = 0;                                                                                                \
    size_t i;                                                                                                     \
    size_t k;                                                                                                     \
    if (instance == NULL || (count > 0 && (references == NULL || values == NULL)) ||                              \
        fmu_elements(references, count) != value_count) {                                                         \
      return fmi3Error;                                                                                           \
    }                                                                                                             \
    for (i = 0; i < count; ++i) {                                                                                 \
      const size_t elements = fmu_elements(&references[i], 1);                                                    \
      for (k = 0; k < elements; ++k) {                                                                            \
        const fmi3Status status = (fmi3Status)fmu_set((fmu_instance *)instance, references[i], k, kinds,          \
                                                      (double)values[at++]);                                      \
        worst = status > worst ? status : worst;                                                                  \
      }                                                                                                           \
    }                                                                                                             \
    return worst;                                                                                                 \
  }

// The time, value reference 0, is a Float64 whatever the model computes with.
FMU_ACCESS(Float32, float, (sizeof(fmu_real_type) == sizeof(float) ? KIND_REAL : 0))
FMU_ACCESS(Float64, double, (sizeof(fmu_real_type) == sizeof(double) ? KIND_REAL | KIND_TIME : KIND_TIME))
FMU_ACCESS(Int8, int8_t, 0)
FMU_ACCESS(UInt8, uint8_t, 0)
FMU_ACCESS(Int16, int16_t, 0)
FMU_ACCESS(UInt16, uint16_t, KIND_WORD)
FMU_ACCESS(Int32, int32_t, KIND_INT)
FMU_ACCESS(UInt32, uint32_t, 0)
FMU_ACCESS(Int64, int64_t, 0)
FMU_ACCESS(UInt64, uint64_t, 0)
FMU_ACCESS(Boolean, bool, KIND_BOOL)

)";

constexpr std::string_view fmi3_refused =
    R"(// --- what a co-simulation without strings, clocks, events and derivatives does not have ---

#define FMU_REFUSED(Name, arguments)                                                                              \
  FMU_EXPORT fmi3Status FMI(Name) arguments {                                                                     \
    return (fmi3Status)fmu_refuse((const fmu_instance *)instance, FMU_ERROR, "this model has no " #Name);         \
  }

#define FMU_REFERENCES fmi3Instance instance, const fmi3ValueReference references[], size_t count
FMU_REFUSED(GetString, (FMU_REFERENCES, const char *values[], size_t value_count))
FMU_REFUSED(SetString, (FMU_REFERENCES, const char *const values[], size_t value_count))
FMU_REFUSED(GetBinary, (FMU_REFERENCES, size_t sizes[], const uint8_t *values[], size_t value_count))
FMU_REFUSED(SetBinary, (FMU_REFERENCES, const size_t sizes[], const uint8_t *const values[], size_t value_count))
FMU_REFUSED(GetClock, (FMU_REFERENCES, bool values[]))
FMU_REFUSED(SetClock, (FMU_REFERENCES, const bool values[]))
FMU_REFUSED(GetNumberOfVariableDependencies, (fmi3Instance instance, fmi3ValueReference reference, size_t *count))
FMU_REFUSED(GetVariableDependencies, (fmi3Instance instance, fmi3ValueReference dependent, size_t dependent_index[],
                                      fmi3ValueReference independents[], size_t independent_index[], int kinds[],
                                      size_t count))
FMU_REFUSED(GetDirectionalDerivative, (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,
                                       const fmi3ValueReference knowns[], size_t known_count, const double seed[],
                                       size_t seed_count, double sensitivity[], size_t sensitivity_count))
FMU_REFUSED(GetAdjointDerivative, (fmi3Instance instance, const fmi3ValueReference unknowns[], size_t unknown_count,
                                   const fmi3ValueReference knowns[], size_t known_count, const double seed[],
                                   size_t seed_count, double sensitivity[], size_t sensitivity_count))
FMU_REFUSED(EnterEventMode, (fmi3Instance instance))
FMU_REFUSED(EnterStepMode, (fmi3Instance instance))
FMU_REFUSED(EnterConfigurationMode, (fmi3Instance instance))
FMU_REFUSED(ExitConfigurationMode, (fmi3Instance instance))
FMU_REFUSED(GetIntervalDecimal, (FMU_REFERENCES, double intervals[], int qualifiers[]))
FMU_REFUSED(GetIntervalFraction, (FMU_REFERENCES, uint64_t counters[], uint64_t resolutions[], int qualifiers[]))
FMU_REFUSED(GetShiftDecimal, (FMU_REFERENCES, double shifts[]))
FMU_REFUSED(GetShiftFraction, (FMU_REFERENCES, uint64_t counters[], uint64_t resolutions[]))
FMU_REFUSED(SetIntervalDecimal, (FMU_REFERENCES, const double intervals[]))
FMU_REFUSED(SetIntervalFraction, (FMU_REFERENCES, const uint64_t counters[], const uint64_t resolutions[]))
FMU_REFUSED(SetShiftDecimal, (FMU_REFERENCES, const double shifts[]))
FMU_REFUSED(SetShiftFraction, (FMU_REFERENCES, const uint64_t counters[], const uint64_t resolutions[]))
FMU_REFUSED(EvaluateDiscreteStates, (fmi3Instance instance))
FMU_REFUSED(UpdateDiscreteStates, (fmi3Instance instance, bool *update, bool *terminate, bool *nominals, bool *values,
                                   bool *event_defined, double *event_time))
FMU_REFUSED(EnterContinuousTimeMode, (fmi3Instance instance))
FMU_REFUSED(CompletedIntegratorStep, (fmi3Instance instance, bool no_return_before, bool *event, bool *terminate))
FMU_REFUSED(SetTime, (fmi3Instance instance, double time))
FMU_REFUSED(SetContinuousStates, (fmi3Instance instance, const double states[], size_t count))
FMU_REFUSED(GetContinuousStateDerivatives, (fmi3Instance instance, double derivatives[], size_t count))
FMU_REFUSED(GetEventIndicators, (fmi3Instance instance, double indicators[], size_t count))
FMU_REFUSED(GetContinuousStates, (fmi3Instance instance, double states[], size_t count))
FMU_REFUSED(GetNominalsOfContinuousStates, (fmi3Instance instance, double nominals[], size_t count))
FMU_REFUSED(GetNumberOfEventIndicators, (fmi3Instance instance, size_t *count))
FMU_REFUSED(GetNumberOfContinuousStates, (fmi3Instance instance, size_t *count))
FMU_REFUSED(GetOutputDerivatives, (FMU_REFERENCES, const int32_t orders[], double values[], size_t value_count))
FMU_REFUSED(ActivateModelPartition, (fmi3Instance instance, fmi3ValueReference clock, double time))
)";

}  // namespace

std::string_view fmi3_functions() {
  static const std::string text = std::string(fmi3_life) + std::string(fmi3_refused);
  return text;
}

}  // namespace hysteron
