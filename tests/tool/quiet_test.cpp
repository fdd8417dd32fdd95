// hysteron --quiet and wrapped output, as a user runs it.
