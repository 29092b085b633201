"""Rules on the flow of messages: topics, services, actions and parameters, and who uses them."""
