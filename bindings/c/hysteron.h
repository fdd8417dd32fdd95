/* Hysteron for programs: diagrams compiled, run, tuned and diagnosed, by the code that the tool runs.
 *
 *   hysteron_messages* messages = NULL;
 *   hysteron_diagram* plant = hysteron_compile_file("plant.st", NULL, &messages);
 *   if (plant == NULL) { fputs(hysteron_messages_text(messages), stderr); }
 *
 * Handles. A function that gives a handle gives NULL where it could not, and says why in `messages`. Each handle is
 * freed by its own function, which takes NULL. A handle that was made of others does not need them any more.
 *
 * Texts are UTF-8, and end with a zero. Those that a handle gives live as long as the handle.
 *
 * Messages. A function takes a pointer to a pointer, or NULL where nobody wants to know. On failure it points to the
 * errors. On success it points to the warnings and notes, or is NULL where there are none. The caller frees it.
 *
 * Options are an object of JSON, or NULL for none: {"params": "tuned.toml", "any_order": true}. A key that is not known
 * is an error. Every function says which it takes.
 *
 * Threads. A handle does not change once it is made, and any number of threads may use it at once. The machine is the
 * exception: one thread at a time steps it. Fits of several threads wait for each other: the optimiser takes one.
 *
 * Numbers have the bits that the tool gives for the same input.
 */
#ifndef HYSTERON_H
#define HYSTERON_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define HYSTERON_API __attribute__((visibility("default")))
#else
#define HYSTERON_API
#endif

/* Raised where a function changes or goes; new functions and new keys do not raise it. */
#define HYSTERON_ABI 1

/* HYSTERON_ABI of the library. */
HYSTERON_API int hysteron_abi(void);
/* Its version, as 0.1.0. */
HYSTERON_API const char* hysteron_version(void);

/* ---- messages --------------------------------------------------------------------------------------------------- */

typedef struct hysteron_messages hysteron_messages;

/* What a message is. A note has a cause alone: it says what was understood. */
#define HYSTERON_ERROR 0
#define HYSTERON_WARNING 1
#define HYSTERON_NOTE 2

HYSTERON_API size_t hysteron_messages_count(const hysteron_messages* messages);
HYSTERON_API int hysteron_message_severity(const hysteron_messages* messages, size_t index);
/* 402 for HY402; 0 for a note, -1 for a fault of the library itself, such as no memory left. */
HYSTERON_API int hysteron_message_code(const hysteron_messages* messages, size_t index);
/* Where: the file is empty, line and column are 0, where there is none. They count from 1. */
HYSTERON_API const char* hysteron_message_file(const hysteron_messages* messages, size_t index);
HYSTERON_API unsigned hysteron_message_line(const hysteron_messages* messages, size_t index);
HYSTERON_API unsigned hysteron_message_column(const hysteron_messages* messages, size_t index);
/* What is wrong, and what to write instead; a sentence each. */
HYSTERON_API const char* hysteron_message_cause(const hysteron_messages* messages, size_t index);
HYSTERON_API const char* hysteron_message_mend(const hysteron_messages* messages, size_t index);
/* All of them as the tool prints them, with the lines that they are about. An option is named as this API takes it:
 * {"rows": "1..60"}, where the tool says --rows 1..60. */
HYSTERON_API const char* hysteron_messages_text(const hysteron_messages* messages);
/* Names the options in the words of another language: rows="1..60" in Python. What was given of these messages before is
 * then no longer valid. */
#define HYSTERON_FOR_C 0
#define HYSTERON_FOR_PYTHON 1
HYSTERON_API void hysteron_messages_for(hysteron_messages* messages, int caller);
HYSTERON_API void hysteron_messages_free(hysteron_messages* messages);

/* ---- diagrams --------------------------------------------------------------------------------------------------- */

typedef struct hysteron_diagram hysteron_diagram;

/* Options of both: "top" (the block to take, where the file has several), "any_order", "params" (a parameter file),
 * "params_text" (its text instead), "parameters" (values over all of these: {"HYST.C1": 8.0}). */
HYSTERON_API hysteron_diagram* hysteron_compile_file(const char* path, const char* options,
                                                     hysteron_messages** messages);
HYSTERON_API hysteron_diagram* hysteron_compile_text(const char* text, const char* options,
                                                     hysteron_messages** messages);
/* The same diagram with other parameters; options "params", "params_text" and "parameters" of the above. Without the
 * first two it keeps its parameter file. */
HYSTERON_API hysteron_diagram* hysteron_with_parameters(const hysteron_diagram* diagram, const char* options,
                                                        hysteron_messages** messages);
/* Name, sample time, and name, unit, meaning, type and range of inputs, outputs and parameters, with their values:
 * docs/reference/schemas/diagram.json. */
HYSTERON_API const char* hysteron_diagram_json(const hysteron_diagram* diagram);
HYSTERON_API size_t hysteron_input_count(const hysteron_diagram* diagram);
HYSTERON_API size_t hysteron_output_count(const hysteron_diagram* diagram);
/* NULL where there is none of that index. */
HYSTERON_API const char* hysteron_input_name(const hysteron_diagram* diagram, size_t index);
HYSTERON_API const char* hysteron_output_name(const hysteron_diagram* diagram, size_t index);
HYSTERON_API void hysteron_diagram_free(hysteron_diagram* diagram);

/* ---- machines: a diagram that is stepped --------------------------------------------------------------------------- */

typedef struct hysteron_machine hysteron_machine;

/* A machine after its reset. The sample time, in seconds, is for a diagram that states none; 0 otherwise. Options:
 * "float32". */
HYSTERON_API hysteron_machine* hysteron_machine_new(const hysteron_diagram* diagram, double sample_time,
                                                    const char* options, hysteron_messages** messages);
/* One step: a value for each input and each output, in the order of the diagram; TRUE is 1. Returns 0; -1 where a
 * pointer is NULL that must not be or an FMU of the diagram fails, and 1 + i where input i cannot take its value, as a
 * record of it would be refused: then no step was made. A step allocates nothing. */
HYSTERON_API int hysteron_machine_step(hysteron_machine* machine, const double* inputs, double* outputs);
HYSTERON_API void hysteron_machine_reset(hysteron_machine* machine);
HYSTERON_API void hysteron_machine_free(hysteron_machine* machine);

/* ---- records ---------------------------------------------------------------------------------------------------- */

typedef struct hysteron_record hysteron_record;

/* Reads a file as the tool does. With a diagram, [record] of its parameter file holds where no option does, and a record
 * is resampled to its sample time; else it is NULL. Options, as those of the tool: "time", "rate", "columns"
 * ({"U": "MAIN.u[mV]"}), "skip", "range", "rows", "decimal", "resample" ("hold", or by
 * signal {"Q": "hold", "*": "linear"}, where * is all others). */
HYSTERON_API hysteron_record* hysteron_record_read(const char* path, const hysteron_diagram* diagram,
                                                   const char* options, hysteron_messages** messages);
/* A record of arrays: columns × rows numbers, column after column. Units may be NULL, and each of them. One column is
 * the time, by the same rules as in a file, or "rate" states the rows per second. Options and diagram as above. */
HYSTERON_API hysteron_record* hysteron_record_new(size_t columns, size_t rows, const char* const* names,
                                                  const char* const* units, const double* values,
                                                  const hysteron_diagram* diagram, const char* options,
                                                  hysteron_messages** messages);
HYSTERON_API size_t hysteron_record_rows(const hysteron_record* record);
HYSTERON_API double hysteron_record_sample_time(const hysteron_record* record);
/* In seconds, of each row. */
HYSTERON_API const double* hysteron_record_time(const hysteron_record* record);
/* What the time is called beside the columns: "t", or "time" where a signal of the diagram is called T. */
HYSTERON_API const char* hysteron_record_time_name(const hysteron_record* record);
/* Columns, without the time. NULL where there is none of that index. */
HYSTERON_API size_t hysteron_record_columns(const hysteron_record* record);
HYSTERON_API const char* hysteron_record_name(const hysteron_record* record, size_t column);
HYSTERON_API const char* hysteron_record_unit(const hysteron_record* record, size_t column);
HYSTERON_API const double* hysteron_record_values(const hysteron_record* record, size_t column);
HYSTERON_API void hysteron_record_free(hysteron_record* record);

/* ---- run, tune, diagnose -------------------------------------------------------------------------------------------- */

/* Runs a diagram from its reset over a record: the outputs, then the traces, as a record. An output that is not finite
 * is an error among the messages, and the record is given all the same. Options: "traces" (["HYST.XOUT"]), "float32". */
HYSTERON_API hysteron_record* hysteron_run(const hysteron_diagram* diagram, const hysteron_record* record,
                                           const char* options, hysteron_messages** messages);

/* Called once an iteration, from the thread that called; `done` is a guess from 0 to 1. Not 0 ends the fit with the best
 * so far. */
typedef int (*hysteron_progress)(void* user, double done, int iteration);

typedef struct hysteron_fit hysteron_fit;

/* Fits what [fit] of the diagram's parameter file names to records; with [goal] it tunes a control loop, by one record or
 * none, as the goal says. Limits that cannot be kept together are an error among the messages, and the point that breaks
 * them least is given all the same. Options: "starts". `progress` may be NULL. */
HYSTERON_API hysteron_fit* hysteron_tune(const hysteron_diagram* diagram, const hysteron_record* const* records,
                                         size_t record_count, const char* options, hysteron_progress progress,
                                         void* user, hysteron_messages** messages);
/* What `tune --json` prints: docs/reference/schemas/fit.json, or goal.json with a goal. */
HYSTERON_API const char* hysteron_fit_json(const hysteron_fit* fit);
/* The parameter file with the fitted values, as `tune --out` writes it. */
HYSTERON_API const char* hysteron_fit_parameters(const hysteron_fit* fit);
HYSTERON_API void hysteron_fit_free(hysteron_fit* fit);

typedef struct hysteron_relay hysteron_relay;

/* What a relay experiment tells: `u` is the column that the relay wrote, `y` the process value. Options: "controller",
 * its instance in the diagram, PID without it. */
HYSTERON_API hysteron_relay* hysteron_relay_experiment(const hysteron_record* record, const char* u, const char* y,
                                                       const char* options, hysteron_messages** messages);
/* What `relay --json` prints: docs/reference/schemas/relay.json. */
HYSTERON_API const char* hysteron_relay_json(const hysteron_relay* relay);
/* The parameter file of a PID to begin with, as `relay --out` writes it. */
HYSTERON_API const char* hysteron_relay_parameters(const hysteron_relay* relay);
HYSTERON_API void hysteron_relay_free(hysteron_relay* relay);

typedef struct hysteron_diagnosis hysteron_diagnosis;

/* Why the records and the diagram differ. Options, as those of the tool: "material", "effects", "ignore", "most",
 * "limits" ({"U": 5.0}), "effort", "time_limit", "seed", "explain", "without", "threads". A record that cannot be
 * diagnosed is no failure: the verdict says so. */
HYSTERON_API hysteron_diagnosis* hysteron_diagnose(const hysteron_diagram* diagram,
                                                   const hysteron_record* const* records, size_t record_count,
                                                   const char* options, hysteron_messages** messages);
/* verdict.json: docs/reference/schemas/verdict.json. */
HYSTERON_API const char* hysteron_diagnosis_verdict(const hysteron_diagnosis* diagnosis);
/* A file that `diagnose --out` would write, by its name, such as improved.st; NULL where there is none. */
HYSTERON_API const char* hysteron_diagnosis_file(const hysteron_diagnosis* diagnosis, const char* name);
HYSTERON_API size_t hysteron_diagnosis_file_count(const hysteron_diagnosis* diagnosis);
HYSTERON_API const char* hysteron_diagnosis_file_name(const hysteron_diagnosis* diagnosis, size_t index);
HYSTERON_API void hysteron_diagnosis_free(hysteron_diagnosis* diagnosis);

#ifdef __cplusplus
}
#endif

#endif
