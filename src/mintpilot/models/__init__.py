"""Language models behind one port: a server, a file on this machine, doubles. They complete prompts, no more."""
