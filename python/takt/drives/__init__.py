"""Drives of metal: CiA 402 over field buses (AX-87, EN-26).

cia402, error_texts and scaling know no bus; axis makes one drive of a set point and a measurement of its words; buses
are CANopen and EtherCAT. emulated is a drive for trying all of it without metal.
"""
