"""Hysteron: control diagrams compiled, run, tuned and diagnosed, with numpy arrays in and out.

    import hysteron
    plant = hysteron.compile("plant.st", "tuned.toml")
    out = plant.run({"U": u})               # the bits of `hysteron run`
    fit = plant.tune("log.csv")             # exact gradients, Ipopt
    pid = loop.tune(params="pid.toml")      # a controller, for a [goal]
    verdict = plant.diagnose("log.csv")     # why machine and model differ

Bad input raises hysteron.Error with code, message and mend. Threads may share diagrams and records; each steps a machine
of its own. docs/how-to/python.md tells the whole.
"""
from . import _library
from ._diagram import Diagram, Machine, Parameter, Port, compile, relay  # noqa: A004
from ._messages import Error, InputWarning, Message
from ._record import Record, read_record
from ._results import (Controller, Effect, Estimate, Family, Fit, Fitted, Gap, Limit, LoopFigures, Margin, Model, Plant,
                       Relay, Rival, Score, Setting, Tuned, TunedLoop, Verdict)

__version__ = _library.library.hysteron_version().decode()

__all__ = ["compile", "read_record", "relay", "Diagram", "Machine", "Port", "Parameter", "Record", "Fit", "Fitted",
           "Score", "TunedLoop", "Tuned", "Plant", "LoopFigures", "Margin", "Limit", "Relay", "Controller", "Model",
           "Verdict", "Effect", "Estimate", "Setting", "Gap", "Family", "Rival", "Error", "Message", "InputWarning"]
