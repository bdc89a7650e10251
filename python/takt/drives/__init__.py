"""Real drives: CiA 402 over field buses (AX-87, EN-26).

cia402, error_texts and scaling are independent of the bus; axis converts between set points, actual values and the
words of one drive; buses are CANopen and EtherCAT. emulated is a drive in software, to run all of it without hardware.
"""
