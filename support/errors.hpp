// The numbers of all diagnostics and their titles. Each has a page docs/errors/HYnnn.md with a failing text and its
// mend. 1xx syntax, 2xx names, types and wires, 3xx units, 4xx loops, rates and scheduling, 5xx records, 6xx
// parameter files, 7xx tuning, tests and the command line, 8xx the runtime and Modbus.
#pragma once

#include <span>
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
inline constexpr int refused_in_body = 129;
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
inline constexpr int other_meaning_elsewhere = 217;
inline constexpr int conditional_call = 218;
inline constexpr int unusable_fmu = 219;
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
inline constexpr int unread_format = 513;
inline constexpr int two_readings = 514;
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
inline constexpr int no_bench = 728;
inline constexpr int unit_of_column = 729;
inline constexpr int bad_usage = 730;
inline constexpr int foreign_file = 731;
inline constexpr int name_too_long = 732;
inline constexpr int unknown_manifest_column = 733;
inline constexpr int no_date = 734;
inline constexpr int no_graphviz = 740;
inline constexpr int graphviz_failed = 741;
inline constexpr int no_network = 742;
inline constexpr int not_plcopen = 743;
inline constexpr int untranslatable_element = 744;
inline constexpr int unfit_elf = 745;
inline constexpr int fmu_without_binary = 748;
inline constexpr int fmu_does_not_start = 750;
inline constexpr int fmu_refuses_step = 751;
inline constexpr int fmu_crashed = 752;
inline constexpr int fmu_took_too_long = 753;
inline constexpr int fmu_out_of_place = 754;
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
inline constexpr int output_of_another_task = 814;
inline constexpr int file_of_another_task = 815;
inline constexpr int unusable_retain_folder = 816;
inline constexpr int foreign_history = 817;
inline constexpr int unreadable_history = 818;
inline constexpr int nothing_in_history = 819;
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
inline constexpr int unusable_tls_file = 831;
inline constexpr int key_of_another_certificate = 832;
inline constexpr int key_open_to_others = 833;
inline constexpr int certificate_out_of_date = 834;
inline constexpr int no_role_may_anything = 835;
inline constexpr int roles_without_tls = 836;
inline constexpr int broken_trace = 840;
inline constexpr int replay_differs = 841;
inline constexpr int malformed_web_address = 842;
inline constexpr int open_web_page = 843;
inline constexpr int unfit_token_file = 844;
}  // namespace error

/// In the order of the numbers.
[[nodiscard]] std::span<const ErrorTitle> error_titles() noexcept;

}  // namespace hysteron
