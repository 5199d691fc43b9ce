"""The paper's sixteen equations as printed, each read and compared with what is derived."""
