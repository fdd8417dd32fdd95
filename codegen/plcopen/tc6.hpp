// The words of PLCopen TC6 XML: elements and attributes, for the export and the import alike.
#pragma once

namespace hysteron::tc6 {

inline constexpr const char* current_namespace = "http://www.plcopen.org/xml/tc6_0201";
inline constexpr const char* older_namespace = "http://www.plcopen.org/xml/tc6_0200";
inline constexpr const char* xhtml_namespace = "http://www.w3.org/1999/xhtml";

// The project.
inline constexpr const char* project = "project";
inline constexpr const char* file_header = "fileHeader";
inline constexpr const char* content_header = "contentHeader";
inline constexpr const char* coordinate_info = "coordinateInfo";
inline constexpr const char* scaling = "scaling";
inline constexpr const char* types = "types";
inline constexpr const char* data_types = "dataTypes";
inline constexpr const char* pous = "pous";
inline constexpr const char* instances = "instances";
inline constexpr const char* configurations = "configurations";
inline constexpr const char* configuration = "configuration";
inline constexpr const char* resource = "resource";
inline constexpr const char* task = "task";
inline constexpr const char* interval = "interval";
inline constexpr const char* pou_instance = "pouInstance";

// A POU and its interface.
inline constexpr const char* pou = "pou";
inline constexpr const char* pou_type = "pouType";
inline constexpr const char* function_block = "functionBlock";
inline constexpr const char* function = "function";
inline constexpr const char* program = "program";
inline constexpr const char* interface = "interface";
inline constexpr const char* return_type = "returnType";
inline constexpr const char* input_vars = "inputVars";
inline constexpr const char* output_vars = "outputVars";
inline constexpr const char* in_out_vars = "inOutVars";
inline constexpr const char* external_vars = "externalVars";
inline constexpr const char* local_vars = "localVars";
inline constexpr const char* temporary_vars = "tempVars";
inline constexpr const char* constant = "constant";
inline constexpr const char* variable = "variable";
inline constexpr const char* type = "type";
inline constexpr const char* derived = "derived";
inline constexpr const char* array = "array";
inline constexpr const char* dimension = "dimension";
inline constexpr const char* base_type = "baseType";
inline constexpr const char* initial_value = "initialValue";
inline constexpr const char* simple_value = "simpleValue";
inline constexpr const char* array_value = "arrayValue";
inline constexpr const char* value = "value";
inline constexpr const char* documentation = "documentation";
inline constexpr const char* body = "body";
inline constexpr const char* structured_text = "ST";
inline constexpr const char* instruction_list = "IL";
inline constexpr const char* function_diagram = "FBD";
inline constexpr const char* ladder_diagram = "LD";

// A network.
inline constexpr const char* in_variable = "inVariable";
inline constexpr const char* out_variable = "outVariable";
inline constexpr const char* in_out_variable = "inOutVariable";
inline constexpr const char* block = "block";
inline constexpr const char* connector = "connector";
inline constexpr const char* continuation = "continuation";
inline constexpr const char* contact = "contact";
inline constexpr const char* coil = "coil";
inline constexpr const char* left_rail = "leftPowerRail";
inline constexpr const char* right_rail = "rightPowerRail";
inline constexpr const char* comment = "comment";
inline constexpr const char* vendor_element = "vendorElement";
inline constexpr const char* input_variables = "inputVariables";
inline constexpr const char* in_out_variables = "inOutVariables";
inline constexpr const char* output_variables = "outputVariables";
inline constexpr const char* formal_parameter = "formalParameter";
inline constexpr const char* point_in = "connectionPointIn";
inline constexpr const char* point_out = "connectionPointOut";
inline constexpr const char* connection = "connection";
inline constexpr const char* reference = "refLocalId";
inline constexpr const char* local_id = "localId";
inline constexpr const char* type_name = "typeName";
inline constexpr const char* instance_name = "instanceName";
inline constexpr const char* execution_order = "executionOrderId";
inline constexpr const char* expression = "expression";
inline constexpr const char* negated = "negated";
inline constexpr const char* negated_in = "negatedIn";
inline constexpr const char* negated_out = "negatedOut";
inline constexpr const char* edge = "edge";
inline constexpr const char* storage = "storage";
inline constexpr const char* position = "position";
inline constexpr const char* relative_position = "relPosition";
inline constexpr const char* width = "width";
inline constexpr const char* height = "height";
inline constexpr const char* name = "name";

}  // namespace hysteron::tc6
