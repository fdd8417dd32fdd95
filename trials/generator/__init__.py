"""Makes records whose cause is known, from continuous-time physics of its own."""
