# Reads and writes every register of a server by pymodbus, as the JSON map describes it.
#
#   interop_pymodbus.py PORT MAP.json     prints a line a point: name and value, read; then adds 1 to each that may be written
import json
import sys

from pymodbus.client import ModbusTcpClient
from pymodbus.constants import Endian
from pymodbus.payload import BinaryPayloadBuilder, BinaryPayloadDecoder

# byte order within a word, order of the words
ORDERS = {"ABCD": (Endian.Big, Endian.Big), "CDAB": (Endian.Big, Endian.Little),
          "BADC": (Endian.Little, Endian.Big), "DCBA": (Endian.Little, Endian.Little)}
NAMES = {"int16": "16bit_int", "uint16": "16bit_uint", "int32": "32bit_int", "uint32": "32bit_uint",
         "int64": "64bit_int", "uint64": "64bit_uint", "real32": "32bit_float", "real64": "64bit_float"}


def main(port, path):
    with open(path, encoding="utf-8") as file:
        about = json.load(file)
    client = ModbusTcpClient("127.0.0.1", port=port, timeout=20)
    assert client.connect()
    for point in about["points"]:
        address, count, kind = point["address"], point["registers"], point["type"]
        if kind == "boolean":
            read = client.read_coils if point["area"] == "coil" else client.read_discrete_inputs
            value = int(read(address, 1).bits[0])
            print(point["name"], value)
            if point["writable"]:
                assert not client.write_coil(address, not value).isError()
            continue
        # a single register has no word order
        byte, word = ORDERS[about["word_order"]] if count > 1 else ORDERS["ABCD"]
        read = client.read_holding_registers if point["area"] == "holding" else client.read_input_registers
        decoder = BinaryPayloadDecoder.fromRegisters(read(address, count).registers, byteorder=byte, wordorder=word)
        value = getattr(decoder, "decode_" + NAMES[kind])()
        print(point["name"], repr(value))
        if point["writable"]:
            builder = BinaryPayloadBuilder(byteorder=byte, wordorder=word)
            getattr(builder, "add_" + NAMES[kind])(value + 1)
            assert not client.write_registers(address, builder.to_registers()).isError()
    client.close()


main(int(sys.argv[1]), sys.argv[2])
