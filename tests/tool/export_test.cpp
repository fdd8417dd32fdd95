// hysteron export, as a user runs it.
