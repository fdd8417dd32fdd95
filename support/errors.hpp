// The numbers of all diagnostics and their titles. Each has a page docs/errors/HYnnn.md with a failing text and its
// mend. 1xx syntax, 2xx names, types and wires, 3xx units, 4xx loops, rates and scheduling, 5xx records, 6xx
// parameter files, 7xx tuning, tests and the command line, 8xx the runtime and Modbus.
#pragma once

#include <array>
#include <string_view>

namespace hysteron {

struct ErrorTitle {
  int number;
  std::string_view title;
};

namespace error {
inline constexpr int unreadable_file = 100;
inline constexpr int illegal_character = 101;
inline constexpr int unexpected_symbol = 102;
inline constexpr int missing_semicolon = 103;
inline constexpr int endless_comment = 104;
inline constexpr int foreign_comment = 105;
inline constexpr int pragma = 106;
inline constexpr int malformed_number = 107;
inline constexpr int number_out_of_range = 108;
inline constexpr int time_literal = 109;
inline constexpr int text_literal = 110;
inline constexpr int control_statement = 111;
inline constexpr int refused_section = 112;
inline constexpr int refused_type = 113;
inline constexpr int name_not_portable = 114;
inline constexpr int missing_end = 115;
inline constexpr int no_function_block = 116;
inline constexpr int outside_function_block = 117;
inline constexpr int argument_form = 118;
inline constexpr int pin_assignment = 119;
inline constexpr int ambiguous_sign = 120;
inline constexpr int nested_too_deeply = 121;
inline constexpr int stray_annotation = 122;
inline constexpr int late_section = 123;
inline constexpr int keyword_as_name = 124;
inline constexpr int too_many_errors = 125;
inline constexpr int array_in_expression = 126;
inline constexpr int direct_address = 127;
inline constexpr int refused_access = 128;
inline constexpr int unknown_block = 201;
inline constexpr int unknown_pin = 202;
inline constexpr int unknown_name = 203;
inline constexpr int unconnected_input = 204;
inline constexpr int double_drive = 205;
inline constexpr int undriven_output = 206;
inline constexpr int type_mismatch = 207;
inline constexpr int duplicate_name = 208;
inline constexpr int reserved_name = 209;
inline constexpr int bad_annotation = 210;
inline constexpr int uncalled_instance = 211;
inline constexpr int unknown_function = 212;
inline constexpr int recursive_block = 213;
inline constexpr int parameter_out_of_range = 214;
inline constexpr int ambiguous_top = 215;
inline constexpr int port_named_as_time = 216;
inline constexpr int unit_mismatch = 301;
inline constexpr int unknown_unit = 302;
inline constexpr int algebraic_loop = 401;
inline constexpr int hidden_delay = 402;
inline constexpr int rate_mismatch = 403;
inline constexpr int missing_sample_time = 404;
inline constexpr int read_after_call = 405;
inline constexpr int rates_too_far_apart = 406;
inline constexpr int record_too_short = 501;
inline constexpr int missing_column = 502;
inline constexpr int duplicate_column = 503;
inline constexpr int ragged_row = 504;
inline constexpr int text_for_number = 505;
inline constexpr int number_not_finite = 506;
inline constexpr int uneven_time = 507;
inline constexpr int reversed_time = 508;
inline constexpr int missing_header = 509;
inline constexpr int not_text = 510;
inline constexpr int ambiguous_decimal_mark = 511;
inline constexpr int time_unit = 512;
inline constexpr int parameter_file_syntax = 601;
inline constexpr int duplicate_key = 602;
inline constexpr int unknown_key = 603;
inline constexpr int wrong_value_type = 604;
inline constexpr int parameter_not_finite = 605;
inline constexpr int contradicting_range = 606;
inline constexpr int unwritable_file = 700;
inline constexpr int sample_time_mismatch = 704;
inline constexpr int input_out_of_range = 705;
inline constexpr int output_not_finite = 706;
inline constexpr int unfit_value = 707;
inline constexpr int unknown_signal = 708;
inline constexpr int overwrites_input = 709;
inline constexpr int too_few_points = 710;
inline constexpr int start_without_value = 711;
inline constexpr int no_room_in_bounds = 712;
inline constexpr int no_motion = 713;
inline constexpr int unusable_point = 714;
inline constexpr int nothing_above_c1 = 715;
inline constexpr int nothing_to_fit = 716;
inline constexpr int no_measured_output = 717;
inline constexpr int nothing_to_train_on = 718;
inline constexpr int no_influence = 719;
inline constexpr int test_file_syntax = 720;
inline constexpr int unknown_test_key = 721;
inline constexpr int wrong_test_value = 722;
inline constexpr int unusable_test = 723;
inline constexpr int missing_test_file = 724;
inline constexpr int no_compiler = 725;
inline constexpr int generated_code_fails = 726;
inline constexpr int no_test_selected = 727;
inline constexpr int bad_usage = 730;
inline constexpr int foreign_file = 731;
inline constexpr int run_file_syntax = 801;
inline constexpr int run_key_twice = 802;
inline constexpr int unknown_run_key = 803;
inline constexpr int wrong_run_value = 804;
inline constexpr int run_value_out_of_range = 805;
inline constexpr int no_safe_value = 806;
inline constexpr int unknown_port_in_run_file = 807;
inline constexpr int unfit_safe_value = 808;
inline constexpr int wrong_period = 809;
inline constexpr int unknown_device = 810;
inline constexpr int retained_values_unfit = 811;
inline constexpr int trace_not_writable = 812;
inline constexpr int device_register_twice = 813;
inline constexpr int register_address_twice = 820;
inline constexpr int lock_file_syntax = 821;
inline constexpr int point_addressed_twice = 822;
inline constexpr int no_address_left = 823;
inline constexpr int malformed_address = 824;
inline constexpr int unfit_address = 825;
inline constexpr int address_of_unknown_point = 826;
inline constexpr int port_in_use = 827;
inline constexpr int privileged_port = 828;
inline constexpr int unusable_listen_address = 829;
inline constexpr int malformed_allow_list = 830;
inline constexpr int broken_trace = 840;
inline constexpr int replay_differs = 841;
inline constexpr int malformed_web_address = 842;
inline constexpr int open_web_page = 843;
inline constexpr int unfit_token_file = 844;
}  // namespace error

inline constexpr std::array error_titles{
    ErrorTitle{error::unreadable_file, "File cannot be read"},
    ErrorTitle{error::illegal_character, "Character that has no meaning"},
    ErrorTitle{error::unexpected_symbol, "Unexpected symbol"},
    ErrorTitle{error::missing_semicolon, "Missing semicolon"},
    ErrorTitle{error::endless_comment, "Comment without an end"},
    ErrorTitle{error::foreign_comment, "Comment that is not portable"},
    ErrorTitle{error::pragma, "Pragma"},
    ErrorTitle{error::malformed_number, "Malformed number"},
    ErrorTitle{error::number_out_of_range, "Number out of range"},
    ErrorTitle{error::time_literal, "Time or date literal"},
    ErrorTitle{error::text_literal, "Text literal"},
    ErrorTitle{error::control_statement, "Control statement"},
    ErrorTitle{error::refused_section, "Section that a diagram does not have"},
    ErrorTitle{error::refused_type, "Type that a diagram does not have"},
    ErrorTitle{error::name_not_portable, "Name that is not portable"},
    ErrorTitle{error::missing_end, "Block or section without an end"},
    ErrorTitle{error::no_function_block, "No FUNCTION_BLOCK in the file"},
    ErrorTitle{error::outside_function_block, "Text outside of a FUNCTION_BLOCK"},
    ErrorTitle{error::argument_form, "Argument in the wrong form"},
    ErrorTitle{error::pin_assignment, "Assignment to a pin"},
    ErrorTitle{error::ambiguous_sign, "Sign whose meaning is not portable"},
    ErrorTitle{error::nested_too_deeply, "Expression nested too deeply"},
    ErrorTitle{error::stray_annotation, "Annotation that belongs to nothing"},
    ErrorTitle{error::late_section, "Section behind the statements"},
    ErrorTitle{error::keyword_as_name, "Keyword used as a name"},
    ErrorTitle{error::too_many_errors, "Too many errors"},
    ErrorTitle{error::array_in_expression, "Array value in an expression"},
    ErrorTitle{error::direct_address, "Direct address"},
    ErrorTitle{error::refused_access, "Element or nested member"},
    ErrorTitle{error::unknown_block, "Unknown block"},
    ErrorTitle{error::unknown_pin, "Unknown pin"},
    ErrorTitle{error::unknown_name, "Unknown name"},
    ErrorTitle{error::unconnected_input, "Unconnected input without a default"},
    ErrorTitle{error::double_drive, "Driven twice"},
    ErrorTitle{error::undriven_output, "Output or variable that nothing drives"},
    ErrorTitle{error::type_mismatch, "Types do not match"},
    ErrorTitle{error::duplicate_name, "Name declared twice"},
    ErrorTitle{error::reserved_name, "Reserved name"},
    ErrorTitle{error::bad_annotation, "Bad annotation"},
    ErrorTitle{error::uncalled_instance, "Instance that is never called"},
    ErrorTitle{error::unknown_function, "Unknown function or wrong arguments"},
    ErrorTitle{error::recursive_block, "Block that contains itself"},
    ErrorTitle{error::parameter_out_of_range, "Parameter out of its range"},
    ErrorTitle{error::ambiguous_top, "No single top block"},
    ErrorTitle{error::port_named_as_time, "Port named as the time"},
    ErrorTitle{error::unit_mismatch, "Units do not match"},
    ErrorTitle{error::unknown_unit, "Unknown unit"},
    ErrorTitle{error::algebraic_loop, "Algebraic loop"},
    ErrorTitle{error::hidden_delay, "Hidden delay"},
    ErrorTitle{error::rate_mismatch, "Wire between two rates"},
    ErrorTitle{error::missing_sample_time, "No sample time"},
    ErrorTitle{error::read_after_call, "Delayed output read after its call"},
    ErrorTitle{error::rates_too_far_apart, "Rates without a usable common period"},
    ErrorTitle{error::record_too_short, "Record with too few rows"},
    ErrorTitle{error::missing_column, "Missing column"},
    ErrorTitle{error::duplicate_column, "Column named twice"},
    ErrorTitle{error::ragged_row, "Row of another length than the header"},
    ErrorTitle{error::text_for_number, "Text where a number belongs"},
    ErrorTitle{error::number_not_finite, "Not a finite number"},
    ErrorTitle{error::uneven_time, "Uneven time"},
    ErrorTitle{error::reversed_time, "Time that repeats or runs back"},
    ErrorTitle{error::missing_header, "No header row"},
    ErrorTitle{error::not_text, "Not a text file in UTF-8"},
    ErrorTitle{error::ambiguous_decimal_mark, "Decimal mark cannot be told"},
    ErrorTitle{error::time_unit, "Time that is not in seconds"},
    ErrorTitle{error::parameter_file_syntax, "Parameter file is not TOML"},
    ErrorTitle{error::duplicate_key, "Key given twice"},
    ErrorTitle{error::unknown_key, "Unknown key in a parameter file"},
    ErrorTitle{error::wrong_value_type, "Value of the wrong type"},
    ErrorTitle{error::parameter_not_finite, "Parameter that is not a finite number"},
    ErrorTitle{error::contradicting_range, "Range or interval that contradicts itself"},
    ErrorTitle{error::unwritable_file, "File cannot be written"},
    ErrorTitle{error::sample_time_mismatch, "Sample times of record and diagram differ"},
    ErrorTitle{error::input_out_of_range, "Input outside of its range"},
    ErrorTitle{error::output_not_finite, "Output that is not a finite number"},
    ErrorTitle{error::unfit_value, "Value that an input cannot take"},
    ErrorTitle{error::unknown_signal, "Unknown signal"},
    ErrorTitle{error::overwrites_input, "Output that would overwrite an input"},
    ErrorTitle{error::too_few_points, "Too few points for a fit"},
    ErrorTitle{error::start_without_value, "Model without a value at the start"},
    ErrorTitle{error::no_room_in_bounds, "Bounds that leave no room for the start"},
    ErrorTitle{error::no_motion, "No sample above the rate threshold"},
    ErrorTitle{error::unusable_point, "Point that a fit cannot use"},
    ErrorTitle{error::nothing_above_c1, "Nothing left for the logarithm of M - C1"},
    ErrorTitle{error::nothing_to_fit, "Nothing to fit"},
    ErrorTitle{error::no_measured_output, "No measured output in the record"},
    ErrorTitle{error::nothing_to_train_on, "Record without a sample to train on"},
    ErrorTitle{error::no_influence, "Parameter without influence"},
    ErrorTitle{error::test_file_syntax, "Test file is not TOML"},
    ErrorTitle{error::unknown_test_key, "Unknown key in a test file"},
    ErrorTitle{error::wrong_test_value, "Wrong value in a test file"},
    ErrorTitle{error::unusable_test, "Test case that cannot be run or checks nothing"},
    ErrorTitle{error::missing_test_file, "No test file"},
    ErrorTitle{error::no_compiler, "No C++ compiler"},
    ErrorTitle{error::generated_code_fails, "Generated code that does not compile or run"},
    ErrorTitle{error::no_test_selected, "No test case to run"},
    ErrorTitle{error::bad_usage, "Command line that is not understood"},
    ErrorTitle{error::foreign_file, "File that Hysteron did not write"},
    ErrorTitle{error::run_file_syntax, "Run file is not TOML"},
    ErrorTitle{error::run_key_twice, "Key given twice in a run file"},
    ErrorTitle{error::unknown_run_key, "Unknown key in a run file"},
    ErrorTitle{error::wrong_run_value, "Value of the wrong type in a run file"},
    ErrorTitle{error::run_value_out_of_range, "Value out of range in a run file"},
    ErrorTitle{error::no_safe_value, "Output without a safe value"},
    ErrorTitle{error::unknown_port_in_run_file, "Input or output that the diagram does not have"},
    ErrorTitle{error::unfit_safe_value, "Safe value that its limits do not allow"},
    ErrorTitle{error::wrong_period, "Period that is not the diagram's"},
    ErrorTitle{error::unknown_device, "Device that is not described"},
    ErrorTitle{error::retained_values_unfit, "Retained values that do not fit"},
    ErrorTitle{error::trace_not_writable, "Trace that cannot be written"},
    ErrorTitle{error::device_register_twice, "One register of a device written twice"},
    ErrorTitle{error::register_address_twice, "Register address given twice"},
    ErrorTitle{error::lock_file_syntax, "Line of a lock file that is not understood"},
    ErrorTitle{error::point_addressed_twice, "Point with two addresses"},
    ErrorTitle{error::no_address_left, "No register address left"},
    ErrorTitle{error::malformed_address, "Register address that is not understood"},
    ErrorTitle{error::unfit_address, "Register address that does not fit its point"},
    ErrorTitle{error::address_of_unknown_point, "Register address of an unknown point"},
    ErrorTitle{error::port_in_use, "Port in use"},
    ErrorTitle{error::privileged_port, "Privileged port without the right"},
    ErrorTitle{error::unusable_listen_address, "Address that cannot be listened on"},
    ErrorTitle{error::malformed_allow_list, "Entry of an allow-list that is not understood"},
    ErrorTitle{error::broken_trace, "Trace that cannot be replayed"},
    ErrorTitle{error::replay_differs, "Replay that gives other bits"},
    ErrorTitle{error::malformed_web_address, "Address of the live page that is not understood"},
    ErrorTitle{error::open_web_page, "Live page open to a network without a token"},
    ErrorTitle{error::unfit_token_file, "Token file that does not serve"},
};

}  // namespace hysteron
