# Writes and reads a register through TLS by pymodbus.
#
#   tls_pymodbus.py PORT CERTIFICATE KEY
#
# Its own framer for TLS leaves the MBAP header away, which Modbus/TCP Security does not: that of sockets is right. That one
# reads an answer in two parts, and pymodbus waits for the second by select, which does not see what TLS has read already.
import sys

from pymodbus.client import ModbusTlsClient
from pymodbus.framer.socket_framer import ModbusSocketFramer


class Client(ModbusTlsClient):
    def recv(self, size):
        self.socket.settimeout(20)
        data = b""
        while len(data) < size:
            part = self.socket.recv(size - len(data))
            if not part:
                break
            data += part
        return data


client = Client("127.0.0.1", port=int(sys.argv[1]), framer=ModbusSocketFramer, certfile=sys.argv[2], keyfile=sys.argv[3],
                server_hostname="localhost", timeout=20)
assert client.connect()
assert not client.write_register(1, 1234).isError()
assert client.read_holding_registers(0, 2).registers == [0, 1234]
assert client.write_register(99, 1).exception_code == 2
client.close()
