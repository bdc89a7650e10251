"""An engine as an OPC UA server, for PLCs and plants (`takt opcua`; needs `takt-motion[opcua]`)."""
