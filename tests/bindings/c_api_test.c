/* The C API as a C99 program uses it: results, errors with code and mend, and every argument that may not be NULL. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/c/hysteron.h"

static int failures = 0;

#define CHECK(condition)                                              \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                     \
    }                                                                 \
  } while (0)

static const char plant_text[] =
    "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n"
    "  VAR_INPUT U : LREAL; (* @unit V *) ON_OFF : BOOL := TRUE; END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR\n"
    "  VAR AMP : HY_GAIN := (K := 2.0); END_VAR\n"
    "  AMP(XIN := SEL(ON_OFF, 0.0, U));\n"
    "  Y := AMP.XOUT;\n"
    "END_FUNCTION_BLOCK\n";

static hysteron_diagram* plant(void) {
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = hysteron_compile_text(plant_text, NULL, &messages);
  if (diagram == NULL) {
    fprintf(stderr, "%s", hysteron_messages_text(messages));
    exit(1);
  }
  hysteron_messages_free(messages);
  return diagram;
}

/* The code of the first message, which is an error and says what to do; 0 where there is none. */
static int code_of(hysteron_messages* messages) {
  int code = 0;
  if (hysteron_messages_count(messages) > 0) {
    code = hysteron_message_code(messages, 0);
    CHECK(hysteron_message_severity(messages, 0) == HYSTERON_ERROR);
    CHECK(strlen(hysteron_message_cause(messages, 0)) > 0);
    CHECK(strlen(hysteron_message_mend(messages, 0)) > 0);
    CHECK(strstr(hysteron_messages_text(messages), hysteron_message_cause(messages, 0)) != NULL);
  }
  hysteron_messages_free(messages);
  return code;
}

static void a_diagram_says_what_it_is(void) {
  hysteron_diagram* diagram = plant();
  CHECK(hysteron_abi() == HYSTERON_ABI);
  CHECK(strlen(hysteron_version()) >= 5);
  CHECK(hysteron_input_count(diagram) == 2 && hysteron_output_count(diagram) == 1);
  CHECK(strcmp(hysteron_input_name(diagram, 0), "U") == 0);
  CHECK(hysteron_input_name(diagram, 2) == NULL);
  CHECK(strcmp(hysteron_output_name(diagram, 0), "Y") == 0);
  CHECK(strstr(hysteron_diagram_json(diagram), "\"AMP.K\"") != NULL);
  hysteron_diagram_free(diagram);
}

static void steps_and_runs_give_the_same(void) {
  enum { rows = 4 };
  const char* names[2] = {"U", "On_Off"};
  const double values[2 * rows] = {0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 0.0, 1.0};
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = plant();
  hysteron_diagram* other = hysteron_with_parameters(diagram, "{\"parameters\": {\"AMP.K\": 3}}", NULL);
  hysteron_record* record = hysteron_record_new(2, rows, names, NULL, values, diagram, "{\"rate\": 1000}", &messages);
  hysteron_record* out;
  hysteron_machine* machine;
  size_t k;
  CHECK(other != NULL && record != NULL);
  hysteron_messages_free(messages);
  hysteron_diagram_free(diagram);
  out = hysteron_run(other, record, NULL, &messages);
  CHECK(out != NULL && messages == NULL);
  machine = hysteron_machine_new(other, 0.0, NULL, NULL);
  hysteron_diagram_free(other); /* what was made of it does not need it */
  hysteron_record_free(record);
  CHECK(hysteron_record_rows(out) == rows && hysteron_record_columns(out) == 1);
  CHECK(strcmp(hysteron_record_name(out, 0), "Y") == 0 && strcmp(hysteron_record_unit(out, 0), "um") == 0);
  CHECK(hysteron_record_sample_time(out) == 0.001 && hysteron_record_time(out)[3] == 0.003);
  CHECK(hysteron_record_values(out, 1) == NULL);
  for (k = 0; k < rows; ++k) {
    double inputs[2];
    double y = -1.0;
    inputs[0] = values[k];
    inputs[1] = values[rows + k];
    CHECK(hysteron_machine_step(machine, inputs, &y) == 0);
    CHECK(y == hysteron_record_values(out, 0)[k]);
    CHECK(y == (inputs[1] != 0.0 ? 3.0 * inputs[0] : 0.0));
  }
  hysteron_machine_free(machine);
  hysteron_record_free(out);
}

/* A T among the outputs of a diagram: its records call their time otherwise. */
static void a_signal_called_t_is_a_signal(void) {
  static const char text[] =
      "FUNCTION_BLOCK OVEN (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT T : LREAL; END_VAR\n"
      "T := 2.0 * U;\nEND_FUNCTION_BLOCK\n";
  const char* names[3] = {"t", "U", "T"};
  const double values[9] = {0.0, 0.001, 0.002, 1.0, 2.0, 4.0, 7.0, 7.0, 9.0};
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = hysteron_compile_text(text, NULL, &messages);
  hysteron_record* record = hysteron_record_new(3, 3, names, NULL, values, diagram, NULL, NULL);
  hysteron_record* out = hysteron_run(diagram, record, NULL, NULL);
  CHECK(messages == NULL);
  CHECK(hysteron_record_columns(record) == 2 && strcmp(hysteron_record_name(record, 1), "T") == 0);
  CHECK(strcmp(hysteron_record_time_name(record), "time") == 0 && hysteron_record_time(record)[2] == 0.002);
  CHECK(strcmp(hysteron_record_time_name(out), "time") == 0);
  CHECK(strcmp(hysteron_record_name(out, 0), "T") == 0 && hysteron_record_values(out, 0)[2] == 8.0);
  hysteron_record_free(out);
  hysteron_record_free(record);
  CHECK(hysteron_record_new(2, 3, names, NULL, values, diagram, NULL, &messages) == NULL && code_of(messages) == 514);
  record = hysteron_record_new(2, 3, names, NULL, values, NULL, NULL, NULL);
  CHECK(strcmp(hysteron_record_time_name(record), "t") == 0 && hysteron_record_columns(record) == 1);
  CHECK(hysteron_record_time_name(NULL) == NULL);
  hysteron_record_free(record);
  hysteron_diagram_free(diagram);
}

static void an_input_of_another_type_makes_no_step(void) {
  hysteron_diagram* diagram = plant();
  hysteron_machine* machine = hysteron_machine_new(diagram, 0.0, NULL, NULL);
  const double inputs[2] = {1.0, 0.5};
  double y = -1.0;
  CHECK(hysteron_machine_step(machine, inputs, &y) == 2 && y == -1.0);
  CHECK(hysteron_machine_step(machine, NULL, &y) == -1);
  CHECK(hysteron_machine_step(machine, inputs, NULL) == -1);
  CHECK(hysteron_machine_step(NULL, inputs, &y) == -1);
  hysteron_machine_free(machine);
  hysteron_diagram_free(diagram);
}

/* An INT and a UDINT of a sequential body are carried by a DINT, and take what their own types hold. */
static void an_input_takes_what_its_declared_type_holds(void) {
  static const char text[] =
      "FUNCTION_BLOCK COUNTED (* @ts 1ms @body *) VAR_INPUT N : INT; M : UDINT; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
      "Y := INT_TO_LREAL(N) + UDINT_TO_LREAL(M);\nEND_FUNCTION_BLOCK\n";
  hysteron_diagram* diagram = hysteron_compile_text(text, NULL, NULL);
  hysteron_machine* machine = hysteron_machine_new(diagram, 0.0, NULL, NULL);
  const double wide[2] = {70000.0, 0.0};
  const double negative[2] = {0.0, -5000000000.0};
  const double fits[2] = {-3.0, 4000000000.0};
  double y = -1.0;
  CHECK(machine != NULL);
  CHECK(hysteron_machine_step(machine, wide, &y) == 1 && y == -1.0);
  CHECK(hysteron_machine_step(machine, negative, &y) == 2 && y == -1.0);
  CHECK(hysteron_machine_step(machine, fits, &y) == 0 && y == 3999999997.0);
  hysteron_machine_free(machine);
  hysteron_diagram_free(diagram);
}

static void errors_have_code_place_and_mend(void) {
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = plant();
  const char* names[1] = {"X"};
  const double values[2] = {0.0, 1.0};
  hysteron_record* record;
  CHECK(hysteron_compile_text("FUNCTION_BLOCK A\nX := ;\nEND_FUNCTION_BLOCK\n", NULL, &messages) == NULL);
  CHECK(strcmp(hysteron_message_file(messages, 0), "diagram") == 0);
  CHECK(hysteron_message_line(messages, 0) == 2 && hysteron_message_column(messages, 0) > 0);
  CHECK(strstr(hysteron_messages_text(messages), "X := ;") != NULL);
  CHECK(code_of(messages) == 102);
  CHECK(hysteron_compile_file("no/such/file.st", NULL, &messages) == NULL && code_of(messages) == 100);
  CHECK(hysteron_compile_text(plant_text, "{\"toop\": \"PLANT\"}", &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_compile_text(plant_text, "[1]", &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_with_parameters(diagram, "{\"parameters\": {\"AMP.Q\": 1}}", &messages) == NULL);
  CHECK(code_of(messages) == 603);
  CHECK(hysteron_with_parameters(diagram, "{\"parameters\": {\"AMP.K\": \"two\"}}", &messages) == NULL);
  CHECK(code_of(messages) == 604);
  record = hysteron_record_new(1, 2, names, NULL, values, NULL, "{\"rate\": \"1kHz\"}", NULL);
  CHECK(record != NULL);
  CHECK(hysteron_run(diagram, record, NULL, &messages) == NULL && code_of(messages) == 502);
  CHECK(hysteron_run(diagram, record, NULL, NULL) == NULL); /* nobody wants to know */
  CHECK(hysteron_record_new(1, 2, names, NULL, values, NULL, NULL, &messages) == NULL && code_of(messages) == 502);
  CHECK(hysteron_record_new(1, 1, names, NULL, values, NULL, "{\"rate\": 1}", &messages) == NULL);
  CHECK(code_of(messages) == 501);
  hysteron_record_free(record);
  hysteron_diagram_free(diagram);
}

/* An integrator under a gain, TS = 10 ms: the loop that settles in 0.5 s as a first-order lag has K = (1 -
 * 50^(-TS/0.5))/TS. */
static const char loop_text[] =
    "FUNCTION_BLOCK LOOP  (* @ts 10ms *)\n"
    "  VAR_INPUT SP : LREAL; END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; END_VAR\n"
    "  VAR P : HY_GAIN := (K := 2.0); PLANT : HY_INTEGRAL_FORWARD; END_VAR\n"
    "  P(XIN := SP - PLANT.XOUT);\n"
    "  Y := PLANT.XOUT;\n"
    "  PLANT(XIN := P.XOUT);\n"
    "END_FUNCTION_BLOCK\n";

/* The diagram with a range of K and a goal. */
static hysteron_diagram* loop_with_goal(const char* range, const char* goal) {
  char file[512];
  hysteron_diagram* diagram = hysteron_compile_text(loop_text, NULL, NULL);
  hysteron_diagram* with_goal;
  snprintf(
      file, sizeof file,
      "{\"params_text\": \"[fit.P]\\nK = {%s}\\n[goal]\\norder = 1\\nsettling_time = 0.5\\nloop = 'P.XOUT'\\n%s\"}",
      range, goal);
  with_goal = hysteron_with_parameters(diagram, file, NULL);
  hysteron_diagram_free(diagram);
  CHECK(with_goal != NULL);
  return with_goal;
}

static int count_and_stop(void* user, double done, int iteration) {
  CHECK(done >= 0.0 && done <= 1.0 && iteration >= 0);
  return ++*(int*)user >= 2;
}

static double tuned_gain(const hysteron_fit* fit) {
  const char* at = strstr(hysteron_fit_parameters(fit), "\nK = ");
  CHECK(at != NULL);
  return at != NULL ? atof(at + 5) : 0.0;
}

static void a_goal_is_tuned_without_a_record(void) {
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = loop_with_goal("min = 0.1, max = 50.0", "");
  hysteron_fit* fit = hysteron_tune(diagram, NULL, 0, "{\"starts\": 2}", NULL, NULL, &messages);
  int calls = 0;
  double gain;
  CHECK(fit != NULL && hysteron_messages_count(messages) == 0);
  hysteron_messages_free(messages);
  gain = tuned_gain(fit);
  CHECK(gain > 7.50 && gain < 7.55);
  CHECK(strstr(hysteron_fit_json(fit), "\"status\": \"tuned\"") != NULL);
  hysteron_fit_free(fit);
  fit = hysteron_tune(diagram, NULL, 0, NULL, count_and_stop, &calls, NULL);
  CHECK(calls >= 2 && fit != NULL && strstr(hysteron_fit_json(fit), "\"status\": \"cancelled\"") != NULL);
  hysteron_fit_free(fit);
  CHECK(hysteron_tune(diagram, NULL, 0, "{\"toop\": 1}", NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  hysteron_diagram_free(diagram);
}

/* The effort of the first step is K: below the lower bound of K no limit on it is kept. */
static void limits_that_cannot_be_kept_are_an_error_beside_the_result(void) {
  hysteron_messages* messages = NULL;
  hysteron_diagram* diagram = loop_with_goal("min = 4.0, max = 20.0, start = 8.0", "[goal.limits]\\neffort = 2.0\\n");
  hysteron_fit* fit = hysteron_tune(diagram, NULL, 0, NULL, NULL, NULL, &messages);
  CHECK(fit != NULL && strstr(hysteron_fit_json(fit), "\"status\": \"contradiction\"") != NULL);
  CHECK(code_of(messages) == 533);
  CHECK(tuned_gain(fit) == 4.0);
  hysteron_fit_free(fit);
  hysteron_diagram_free(diagram);
  diagram = hysteron_compile_text(loop_text, NULL, NULL);
  CHECK(hysteron_tune(diagram, NULL, 0, NULL, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  hysteron_diagram_free(diagram);
}

static void null_is_refused_or_does_nothing(void) {
  hysteron_messages* messages = NULL;
  const double values[2] = {0.0, 1.0};
  const char* names[1] = {NULL};
  CHECK(hysteron_compile_file(NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_compile_text(NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_with_parameters(NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_machine_new(NULL, 0.0, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_record_read(NULL, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_record_new(1, 2, NULL, NULL, values, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_record_new(1, 2, names, NULL, values, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_record_new(1, 2, names, NULL, NULL, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_run(NULL, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_tune(NULL, NULL, 0, NULL, NULL, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_diagnose(NULL, NULL, 0, NULL, &messages) == NULL && code_of(messages) == 730);
  CHECK(hysteron_messages_count(NULL) == 0 && strcmp(hysteron_messages_text(NULL), "") == 0);
  CHECK(hysteron_message_code(NULL, 0) == 0 && strcmp(hysteron_message_mend(NULL, 3), "") == 0);
  CHECK(hysteron_diagram_json(NULL) == NULL && hysteron_input_count(NULL) == 0 &&
        hysteron_output_name(NULL, 0) == NULL);
  CHECK(hysteron_record_rows(NULL) == 0 && hysteron_record_time(NULL) == NULL && hysteron_record_name(NULL, 0) == NULL);
  CHECK(hysteron_fit_json(NULL) == NULL && hysteron_fit_parameters(NULL) == NULL);
  CHECK(hysteron_diagnosis_verdict(NULL) == NULL && hysteron_diagnosis_file_name(NULL, 0) == NULL);
  hysteron_messages_free(NULL);
  hysteron_diagram_free(NULL);
  hysteron_machine_reset(NULL);
  hysteron_machine_free(NULL);
  hysteron_record_free(NULL);
  hysteron_fit_free(NULL);
  hysteron_diagnosis_free(NULL);
}

int main(void) {
  a_diagram_says_what_it_is();
  steps_and_runs_give_the_same();
  a_signal_called_t_is_a_signal();
  an_input_of_another_type_makes_no_step();
  an_input_takes_what_its_declared_type_holds();
  errors_have_code_place_and_mend();
  a_goal_is_tuned_without_a_record();
  limits_that_cannot_be_kept_are_an_error_beside_the_result();
  null_is_refused_or_does_nothing();
  return failures == 0 ? 0 : 1;
}
