#include "codegen/backends/fmu/wrapper.hpp"

namespace hysteron {

std::string_view fmi2_declarations() {
  return R"(// With FMI2_FUNCTION_PREFIX, several models can be linked into one program.
#define FMU_JOINED(prefix, name) prefix##name
#define FMU_PREFIXED(prefix, name) FMU_JOINED(prefix, name)
#if defined(FMI2_FUNCTION_PREFIX)
#define FMI(name) FMU_PREFIXED(FMI2_FUNCTION_PREFIX, fmi2##name)
#else
#define FMI(name) fmi2##name
#endif

typedef void *fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef int fmi2Boolean;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef struct {
  void (*logger)(void *environment, const char *instance, fmi2Status status, const char *category,
                 const char *message, ...);
  void *(*allocateMemory)(size_t count, size_t size);
  void (*freeMemory)(void *memory);
  void (*stepFinished)(void *environment, fmi2Status status);
  void *componentEnvironment;
} fmi2CallbackFunctions;

enum { FMU_OK = fmi2OK, FMU_DISCARD = fmi2Discard, FMU_ERROR = fmi2Error };

typedef struct {
  const fmi2CallbackFunctions *callbacks;
} fmu_logger;

static void fmu_say(const fmu_logger *logger, int status, const char *text) {
  if (logger->callbacks != NULL && logger->callbacks->logger != NULL) {
    logger->callbacks->logger(logger->callbacks->componentEnvironment, FMU_NAME, (fmi2Status)status, "logStatusError",
                              "%s", text);
  }
}

)";
}

std::string_view fmi2_functions() {
  return R"(// --- FMI 2.0 ---

FMU_EXPORT const char *FMI(GetTypesPlatform)(void) {
  return "default";
}

FMU_EXPORT const char *FMI(GetVersion)(void) {
  return "2.0";
}

FMU_EXPORT fmi2Status FMI(SetDebugLogging)(fmi2Component instance, fmi2Boolean on, size_t count,
                                           const char *const names[]) {
  size_t i;
  if (instance == NULL || (count > 0 && names == NULL)) {
    return fmi2Error;
  }
  (void)on;  // only refusals are logged, and always
  for (i = 0; i < count; ++i) {
    if (!fmu_same_text(names[i], "logStatusError")) {
      return (fmi2Status)fmu_refuse((fmu_instance *)instance, FMU_ERROR, "the only log category is logStatusError");
    }
  }
  return fmi2OK;
}

FMU_EXPORT fmi2Component FMI(Instantiate)(const char *name, int type, const char *token, const char *resources,
                                          const fmi2CallbackFunctions *callbacks, fmi2Boolean visible,
                                          fmi2Boolean logging) {
  fmu_logger logger;
  logger.callbacks = callbacks;
  if (type != 1) {
    fmu_say(&logger, FMU_ERROR, "this model is for co-simulation alone");
    return NULL;
  }
  return fmu_new(token, &logger);
}

FMU_EXPORT void FMI(FreeInstance)(fmi2Component instance) {
  free(instance);
}

FMU_EXPORT fmi2Status FMI(SetupExperiment)(fmi2Component instance, fmi2Boolean tolerance_defined, double tolerance,
                                           double start, fmi2Boolean stop_defined, double stop) {
  if (instance == NULL) {
    return fmi2Error;
  }
  if (((fmu_instance *)instance)->values.phase != PHASE_NEW) {
    return (fmi2Status)fmu_refuse((fmu_instance *)instance, FMU_ERROR, "an experiment is set up before the start");
  }
  return (fmi2Status)fmu_begin((fmu_instance *)instance, start, stop_defined != 0, stop);
}

FMU_EXPORT fmi2Status FMI(EnterInitializationMode)(fmi2Component instance) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_enter_initialization((fmu_instance *)instance);
}

FMU_EXPORT fmi2Status FMI(ExitInitializationMode)(fmi2Component instance) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_exit_initialization((fmu_instance *)instance);
}

FMU_EXPORT fmi2Status FMI(Terminate)(fmi2Component instance) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_end((fmu_instance *)instance);
}

FMU_EXPORT fmi2Status FMI(Reset)(fmi2Component instance) {
  if (instance == NULL) {
    return fmi2Error;
  }
  fmu_restart(&((fmu_instance *)instance)->values);
  return fmi2OK;
}

FMU_EXPORT fmi2Status FMI(DoStep)(fmi2Component instance, double time, double step, fmi2Boolean no_return_before) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_advance((fmu_instance *)instance, time, step);
}

FMU_EXPORT fmi2Status FMI(GetFMUstate)(fmi2Component instance, void **state) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_save((fmu_instance *)instance, state);
}

FMU_EXPORT fmi2Status FMI(SetFMUstate)(fmi2Component instance, void *state) {
  return instance == NULL ? fmi2Error : (fmi2Status)fmu_restore((fmu_instance *)instance, state);
}

FMU_EXPORT fmi2Status FMI(FreeFMUstate)(fmi2Component instance, void **state) {
  if (state != NULL) {
    free(*state);
    *state = NULL;
  }
  return fmi2OK;
}

FMU_EXPORT fmi2Status FMI(SerializedFMUstateSize)(fmi2Component instance, void *state, size_t *size) {
  if (instance == NULL || size == NULL) {
    return fmi2Error;
  }
  *size = fmu_bytes();
  return fmi2OK;
}

FMU_EXPORT fmi2Status FMI(SerializeFMUstate)(fmi2Component instance, void *state, char bytes[], size_t size) {
  return instance == NULL ? fmi2Error
                          : (fmi2Status)fmu_write_bytes((fmu_instance *)instance, state, (uint8_t *)bytes, size);
}

FMU_EXPORT fmi2Status FMI(DeSerializeFMUstate)(fmi2Component instance, const char bytes[], size_t size, void **state) {
  return instance == NULL ? fmi2Error
                          : (fmi2Status)fmu_read_bytes((fmu_instance *)instance, (const uint8_t *)bytes, size, state);
}

#define FMU_ACCESS(Name, Number, kinds)                                                                           \
  FMU_EXPORT fmi2Status FMI(Get##Name)(fmi2Component instance, const fmi2ValueReference references[], size_t count, \
                                       Number values[]) {                                                         \
    fmi2Status worst = fmi2OK;                                                                                    \
    size_t i;                                                                                                     \
    if (instance == NULL || (count > 0 && (references == NULL || values == NULL))) {                              \
      return fmi2Error;                                                                                           \
    }                                                                                                             \
    for (i = 0; i < count && worst == fmi2OK; ++i) {                                                              \
      double value = 0.0;                                                                                         \
      worst = (fmi2Status)fmu_get((fmu_instance *)instance, references[i], 0, kinds, &value);                        \
      if (worst == fmi2OK) {                                                                                      \
        values[i] = (Number)value;                                                                                \
      }                                                                                                           \
    }                                                                                                             \
    return worst;                                                                                                 \
  }                                                                                                               \
                                                                                                                  \
  FMU_EXPORT fmi2Status FMI(Set##Name)(fmi2Component instance, const fmi2ValueReference references[], size_t count, \
                                       const Number values[]) {                                                   \
    fmi2Status worst = fmi2OK;                                                                                    \
    size_t i;                                                                                                     \
    if (instance == NULL || (count > 0 && (references == NULL || values == NULL))) {                              \
      return fmi2Error;                                                                                           \
    }                                                                                                             \
    for (i = 0; i < count; ++i) {                                                                                 \
      const fmi2Status status =                                                                                   \
          (fmi2Status)fmu_set((fmu_instance *)instance, references[i], 0, kinds, (double)values[i]);                 \
      worst = status > worst ? status : worst;                                                                    \
    }                                                                                                             \
    return worst;                                                                                                 \
  }

FMU_ACCESS(Real, double, KIND_REAL)
FMU_ACCESS(Integer, int, (KIND_INT | KIND_WORD))
FMU_ACCESS(Boolean, fmi2Boolean, KIND_BOOL)

// --- what a co-simulation without strings, derivatives and pending steps does not have ---

#define FMU_REFUSED(Name, arguments)                                                                              \
  FMU_EXPORT fmi2Status FMI(Name) arguments {                                                                     \
    return (fmi2Status)fmu_refuse((const fmu_instance *)instance, FMU_ERROR, "this model has no " #Name);         \
  }

#define FMU_REFERENCES fmi2Component instance, const fmi2ValueReference references[], size_t count
FMU_REFUSED(GetString, (FMU_REFERENCES, const char *values[]))
FMU_REFUSED(SetString, (FMU_REFERENCES, const char *const values[]))
FMU_REFUSED(GetDirectionalDerivative, (fmi2Component instance, const fmi2ValueReference unknowns[], size_t unknown_count,
                                       const fmi2ValueReference knowns[], size_t known_count, const double seed[],
                                       double sensitivity[]))
FMU_REFUSED(SetRealInputDerivatives, (FMU_REFERENCES, const int orders[], const double values[]))
FMU_REFUSED(GetRealOutputDerivatives, (FMU_REFERENCES, const int orders[], double values[]))
FMU_REFUSED(CancelStep, (fmi2Component instance))
FMU_REFUSED(GetStatus, (fmi2Component instance, int kind, fmi2Status *value))
FMU_REFUSED(GetRealStatus, (fmi2Component instance, int kind, double *value))
FMU_REFUSED(GetIntegerStatus, (fmi2Component instance, int kind, int *value))
FMU_REFUSED(GetBooleanStatus, (fmi2Component instance, int kind, fmi2Boolean *value))
FMU_REFUSED(GetStringStatus, (fmi2Component instance, int kind, const char **value))
)";
}

}  // namespace hysteron
