"""Published detectors of a sticking valve in a control loop, written here from their papers, as peers of the diagnosis.

Each takes the controller's output OP and the process value PV, as sampled, and answers with a score from 0 to 1; its paper's
own threshold says from which score on it calls stiction. They need an oscillation and know nothing of the loop's diagram.
"""
